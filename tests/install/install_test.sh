#!/bin/sh
# The installed program needs nothing of the source tree: it runs elsewhere, with the source folder hidden.
#   install_test.sh CMAKE BUILD SOURCE
set -e
cmake=$1 build=$2 source=$3
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
DESTDIR='' "$cmake" --install "$build" --prefix "$prefix/usr" >"$prefix/log"

for file in bin/dinal share/man/man1/dinal.1 share/dinal/examples/README.md share/dinal/examples/classic.lua \
    share/doc/dinal/LICENSE share/doc/dinal/README.md share/doc/dinal/docs/manual.md share/doc/dinal/docs/report/fig22.svg; do
    [ -s "$prefix/usr/$file" ] || { echo "$file was not installed"; exit 1; }
done
(cd "$source" && find examples -type f) | while read -r file; do
    [ -s "$prefix/usr/share/dinal/$file" ] || { echo "$file was not installed"; exit 1; }
done

cat >"$prefix/run" <<'END'
#!/bin/sh
# Run with the prefix as $1, and the source as $2 where an empty folder can be mounted upon it.
set -e
if [ -n "$2" ]; then
    mount -t tmpfs none "$2"
    [ ! -e "$2/CMakeLists.txt" ]
fi
mkdir "$1/elsewhere" && cd "$1/elsewhere"
dinal=$1/usr/bin/dinal
[ "$("$dinal" -e 'print(system{ I = 1, k = 4 * math.pi^2 }.T0)')" = 1.0 ]
for example in "$1"/usr/share/dinal/examples/0*.lua; do
    "$dinal" "$example" >out </dev/null || { echo "$example does not run where it is installed"; exit 1; }
    [ -s out ]
done
# The figures of the report share a module and go into the current folder here, with gnuplot or without.
"$dinal" "$1/usr/share/dinal/examples/report/all.lua" >out </dev/null
[ -s fig22.svg ] || [ -s fig22.gp ] || { echo "the figures of the report are not drawn where they are installed"; exit 1; }
"$dinal" --manual | cmp - "$1/usr/share/doc/dinal/docs/manual.md"
END
if unshare -rm true 2>/dev/null; then
    unshare -rm sh "$prefix/run" "$prefix" "$source"
    echo "installed, and run with the source hidden"
else
    sh "$prefix/run" "$prefix" ''
    echo "installed, and run; the source could not be hidden, for unshare is not allowed here"
fi
