#!/usr/bin/env bash
# What is handed in for the course: `dist/submission.sh SCENES ARCHIVE [CODE]` makes an archive (.tar.gz, or .zip where there is zip)
# with `Code`, `Screenshots` (a picture of each scene text below the folder SCENES) and `ReadMe.md`. CODE is a folder, of which git's
# files are taken, or all where it is in no repository; without a word the repository of this script. Needs rtc. Nothing is made
# where a scene has errors.
set -euo pipefail

[[ $# -ge 2 ]] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
case $2 in
*.tar.gz | *.zip) ;;
*) echo "submission.sh: the archive is a .tar.gz or a .zip, not \`$2\`" >&2; exit 2 ;;
esac
scenes=$(realpath -- "$1") archive=$(realpath -m -- "$2") code=$(realpath -- "${3:-$(dirname "$0")/..}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/Code" "$folder/Screenshots"

# What is below the folder of the code: names end with a NUL. A tracked file that was deleted is none.
cd "$code"
if git rev-parse --git-dir >/dev/null 2>&1; then
    git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
        [[ ! -f $file ]] || printf '%s\0' "$file"
    done
else
    find . -type f -not -path '*/.*' -print0
fi | sort -z | tar --null --no-recursion --files-from=- -cf - | tar -xf - -C "$folder/Code"

# Pictures have the names of their scenes; two of one name are refused.
cd "$scenes"
texts='**/*.{yaml,yml,json}'
rtc check -q -- "$texts"
rtc render -q -o "$folder/Screenshots/" -- "$texts"

{
    printf '# ReadMe\n\nPictures by `%s`. `Code` has the sources, and `Screenshots` a picture of each scene.\n\n' "$(rtc --version | head -n 1)"
    printf 'Each picture is made by `rtc render SCENE -o PICTURE`.\n\n'
    cd "$folder/Screenshots"
    find . -type f -name '*.png' | sort | sed 's|^\./\(.*\)$|- `Screenshots/\1`|'
} >"$folder/ReadMe.md"

cd "$folder"
# The archive of before stays until the new one is whole.
mkdir -p "$(dirname "$archive")"
part=$(mktemp -d "$archive.XXXXXX")
trap 'rm -rf "$folder" "$part"' EXIT
case $archive in
*.zip) zip -qrX "$part/made.zip" Code Screenshots ReadMe.md ;;
*) tar --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -cf - Code Screenshots ReadMe.md | gzip -n >"$part/made.tar.gz" ;;
esac
mv -f "$part"/made.* "$archive"
echo "$archive: $(find Screenshots -type f | wc -l) pictures, $(find Code -type f | wc -l) files of code"
