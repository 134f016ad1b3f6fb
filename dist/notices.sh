#!/usr/bin/env bash
# The licences of the packages that the program for a target is made of, each with the texts that it comes with:
# `dist/notices.sh TARGET`. Needs the sources of the packages, which a build has fetched.
set -euo pipefail
cd "$(dirname "$0")/.."

sources=${CARGO_HOME:-$HOME/.cargo}/registry/src
printf 'This program contains the following packages, under the licences that follow their names.\n'
cargo tree --quiet --locked --package rtc --edges normal --target "$1" --prefix none --format '{p}|{l}' |
    sed 's/ ([^)]*)//' | sort -u | while IFS='|' read -r package licence; do
    folder=$(printf '%s\n' "$sources"/*/"${package/ v/-}" | tail -n 1)
    # Those of this repository have its own licence.
    [[ -d $folder ]] || continue
    printf '\n%s\n%s, %s\n\n' "$(printf '=%.0s' {1..80})" "$package" "$licence"
    find "$folder" -maxdepth 1 -type f \( -iname 'licen[cs]e*' -o -iname 'copying*' -o -iname 'notice*' -o -iname 'unlicense*' \) |
        LC_ALL=C sort | while IFS= read -r file; do
        cat "$file"
        printf '\n'
    done
done
