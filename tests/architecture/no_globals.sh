#!/bin/sh
# The core library has no variable that anybody could change: nothing of its own in .data, .bss and their kin.
set -e
[ -s "$1" ]
objdump -t "$1" | awk '
    # value, flags (7 columns), section, size, name
    $0 ~ /[ \t]\.(data|bss|tdata|tbss)/ && $0 !~ /\.data\.rel\.ro|DW\.ref\.| d  \./ { print "mutable: " $0; found = 1 }
    { lines++ }
    END { if (lines < 100) { print "no symbols seen"; exit 1 } exit found }' | c++filt >found.$$ || { cat found.$$; rm found.$$; exit 1; }
rm found.$$
