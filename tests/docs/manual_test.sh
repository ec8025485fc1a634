#!/bin/sh
# docs/manual.md is what `dinal --manual` writes, and the man page is free of mistakes.
set -e
program=$1 source=$2
stale() { echo "$1 is stale: write the manual again with scripts/manual"; exit 1; }
"$program" --manual | diff -u "$source/docs/manual.md" - || stale docs/manual.md
for page in $(grep -o '(manual/[a-z]*\.md)' "$source/docs/manual.md" | sed 's/.*\/\(.*\)\.md)/\1/'); do
    "$program" "--manual=$page" | diff -u "$source/docs/manual/$page.md" - || stale "docs/manual/$page.md"
done
complaints=$(groff -man -ww -Tutf8 "$source/docs/dinal.1" 2>&1 >/dev/null)
[ -z "$complaints" ] || { echo "$complaints"; exit 1; }
version=$("$program" -e 'print(dinal.version)')
grep -q "^\.TH DINAL 1 [0-9-]* \"dinal $version\"" "$source/docs/dinal.1" || { echo "the man page is not that of $version"; exit 1; }
grep -q "^## $version " "$source/CHANGELOG.md" || { echo "CHANGELOG.md has no heading for $version"; exit 1; }
# The man page names each member of the table dinal.
for name in $("$program" -e 'for name in pairs(dinal) do print(name) end'); do
    sed -n '/^\.SH DESCRIPTION/,/^\.SH OPTIONS/p' "$source/docs/dinal.1" | grep -qE "^\.BR? $name( |\$)" ||
        { echo "the man page lacks dinal.$name"; exit 1; }
done
# The help and the manual say nothing that is not so.
! grep -rn "for any M" "$source/docs/manual" || { echo "the manual promises too much"; exit 1; }
# Each option that the program lists has its place in the man page.
"$program" --help | grep -oE '(^|[ ,])--?[A-Za-z][a-z-]*' | tr -d ' ,' | sort -u >options.$$
for option in $(cat options.$$); do
    sed 's/\\-/-/g' "$source/docs/dinal.1" | grep -qe "$option" || { echo "the man page lacks $option"; rm options.$$; exit 1; }
done
rm options.$$
