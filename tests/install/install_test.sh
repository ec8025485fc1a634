#!/bin/sh
# The installed program needs nothing of the source tree: it runs elsewhere, with the source folder hidden. So do the
# archive and the Debian package, and a program in C++ is built by what is installed.
#   install_test.sh CMAKE BUILD SOURCE COMPILER
set -e
cmake=$1 build=$2 source=$3 compiler=$4
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
DESTDIR='' "$cmake" --install "$build" --prefix "$prefix/usr" >"$prefix/log"

# An empty entry in the path of libraries is the current folder: a library planted there would run.
for program in "$build/dinal" "$prefix/usr/bin/dinal"; do
    readelf -d "$program" >"$prefix/out"
    path=$(sed -n 's/.*(R[A-Z]*PATH).*\[\(.*\)\]$/\1/p' "$prefix/out")
    grep -q BIND_NOW "$prefix/out" || { echo "$program binds its symbols late"; exit 1; }
    [ "$path" = '$ORIGIN/../lib/dinal' ] || { echo "$program looks for libraries in '$path'"; exit 1; }
done

for file in bin/dinal share/man/man1/dinal.1 share/dinal/examples/README.md share/dinal/examples/classic.lua \
    share/doc/dinal/LICENSE share/doc/dinal/README.md share/doc/dinal/docs/manual.md share/doc/dinal/docs/report/fig22.svg; do
    [ -s "$prefix/usr/$file" ] || { echo "$file was not installed"; exit 1; }
done
(cd "$source" && find examples -type f) | while read -r file; do
    [ -s "$prefix/usr/share/dinal/$file" ] || { echo "$file was not installed"; exit 1; }
done

# find_package(dinal), with one source that uses headers of several rooms.
(cd "$prefix" && "$cmake" -S usr/share/dinal/examples/cpp -B cpp -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_PREFIX_PATH="$prefix/usr" && "$cmake" --build cpp) >"$prefix/log" 2>&1 || { cat "$prefix/log"; exit 1; }
"$prefix/cpp/sticking" >"$prefix/out"
# The same run in Lua tells the same.
"$prefix/usr/bin/dinal" -e '
    run = system{ I = 1, k = 4, Rd = .3, Re = .5 }:simulate{ M = excitation.harmonic{ amplitude = .6, omega = .5 }, theta0 = 1, t_end = 20, dt = .01 }
    for _, e in ipairs(run.events) do print(string.format("%s at t = %.6g, theta = %.6g", e.kind, e.t, e.theta)) end
    print(string.format("theta(1.2345) = %.6g\n\n%s", run:at(1.2345), run:explain()))' | diff - "$prefix/out"

# The Python module, from where it is installed, and from a wheel that pip makes of it without a network, in a plain
# virtual environment: the module finds Debian's NumPy.
init=$(find "$prefix/usr/lib" -path '*/dist-packages/dinal/__init__.py')
if [ -n "$init" ]; then
    module=$(dirname "$init")
    folder=$(dirname "$module")
    readelf -d "$module"/_dinal.*.so >"$prefix/out"
    grep -q 'PATH).*\[$ORIGIN/../../../dinal\]$' "$prefix/out" || { echo "the module looks for libraries elsewhere"; cat "$prefix/out"; exit 1; }
    (cd "$prefix" && PYTHONPATH=$folder /usr/bin/python3 -c 'import dinal; print(dinal.system(I=1, k=4).omega0)') | grep -qx 2.0
    for file in __init__.pyi py.typed stubs.py; do [ -e "$module/$file" ] || { echo "$file was not installed"; exit 1; }; done
    /usr/bin/python3 -m venv "$prefix/venv"
    "$prefix/venv/bin/pip" install --quiet --no-cache-dir --no-index --config-settings=build="$build" "$source" >"$prefix/log" 2>&1 ||
        { cat "$prefix/log"; exit 1; }
    (cd "$prefix" && "$prefix/venv/bin/python" -c 'import dinal; dinal.system(I=1, k=4).simulate(theta0=1, t_end=1).theta[0]; print(dinal.__version__)') >"$prefix/out"
    "$prefix/usr/bin/dinal" -e 'print(dinal.version)' | cmp - "$prefix/out"
fi

# What is handed to others. Quickly, not small.
if command -v dpkg-shlibdeps >/dev/null; then
    PACKAGE_LEVEL=1 "$source/scripts/package" "$build" "$prefix/made" >"$prefix/log"
    version=$("$prefix/usr/bin/dinal" -e 'print(dinal.version)')
    mkdir "$prefix/anywhere" && tar -C "$prefix/anywhere" -xzf "$prefix/made/dinal-$version-linux-$(uname -m).tar.gz"
    dpkg-deb -x "$prefix"/made/dinal_"$version"_*.deb "$prefix/package"
    for tree in "$prefix"/anywhere/dinal-"$version"-* "$prefix/package/usr"; do
        [ "$("$tree/bin/dinal" -e 'print(6 * 7)')" = 42 ]
        [ "$(ldd "$tree/bin/dinal" | grep -c "=> $(readlink -f "$tree")/")" -ge 3 ] ||
            { echo "$tree/bin/dinal does not take the libraries beside it:"; ldd "$tree/bin/dinal"; exit 1; }
    done
    dpkg-deb -f "$prefix"/made/dinal_"$version"_*.deb Depends >"$prefix/out"
    grep -q 'libc6 (>= ' "$prefix/out" && ! grep -qE 'lua|fmt|utf8proc' "$prefix/out" || { cat "$prefix/out"; exit 1; }
    # Nothing of this machine is left in what was made for all users.
    for kernel in dinal dinal-safe; do
        grep -q '"DINAL": "/usr/bin/dinal"' "$prefix/package/usr/share/jupyter/kernels/$kernel/kernel.json"
    done
    if [ -d "$module" ]; then
        dpkg-deb -x "$prefix"/made/python3-dinal_"$version"_*.deb "$prefix/package"
        PYTHONPATH=$prefix/package/usr/lib/python3/dist-packages /usr/bin/python3 -c 'import dinal; print(dinal.system(I=1, k=4).omega0)' | grep -qx 2.0
        [ "$(ldd "$prefix"/package/usr/lib/python3/dist-packages/dinal/_dinal.*.so | grep -c "/package/usr/lib/python3")" -ge 3 ]
        rm -rf "$prefix"/package/usr/lib/python3/dist-packages/dinal/__pycache__
    fi
    # The licences of all that is compiled in or carried; no example that needs the library for C++.
    for words in Eigen MPL-2.0 nlohmann-json; do
        grep -q "$words" "$prefix/package/usr/share/doc/dinal/copyright" || { echo "the copyright is silent on $words"; exit 1; }
    done
    for tree in "$prefix"/anywhere/dinal-"$version"-* "$prefix/package/usr"; do
        [ "$tree" != "$prefix/package/usr" ] || [ ! -d "$module" ] || [ -s "$tree/share/doc/python3-dinal/licences/pybind11-dev" ]
        for text in libeigen3-dev nlohmann-json3-dev MPL-2.0 GPL-3; do
            [ -s "$tree/share/doc/dinal/licences/$text" ] || { echo "the text of $text is missing in $tree"; exit 1; }
        done
        [ ! -e "$tree/share/dinal/examples/cpp" ] || { echo "$tree has an example that it cannot build"; exit 1; }
    done
    ! grep -rlF "$prefix" "$prefix/package" "$prefix/anywhere" || exit 1
    gzip -dc "$prefix/package/usr/share/man/man1/dinal.1.gz" | cmp - "$source/docs/dinal.1"
else
    echo "dpkg-dev is not installed, so no packages were made"
fi

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
# The figures of the report share a module and go into the current folder here; each is drawn by a test of its own.
"$dinal" "$1/usr/share/dinal/examples/report/fig22.lua" >out </dev/null
[ -s fig22.svg ] || { echo "the figures of the report are not drawn where they are installed"; exit 1; }
"$dinal" --manual | cmp - "$1/usr/share/doc/dinal/docs/manual.md"
END
if unshare -rm true 2>/dev/null; then
    unshare -rm sh "$prefix/run" "$prefix" "$source"
    echo "installed, and run with the source hidden"
else
    sh "$prefix/run" "$prefix" ''
    echo "installed, and run; the source could not be hidden, for unshare is not allowed here"
fi
