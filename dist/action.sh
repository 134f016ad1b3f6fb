#!/usr/bin/env bash
# What action.yml does: `dist/action.sh check|thumbnails|compare FOLDER`, results going to the folder. SCENES are files, folders and
# patterns, a line each (all below here without); SIZE the side of pictures; BASE, for `compare`, the commit before. Needs rtc, and
# for `compare` git.
set -euo pipefail

what=$1 out=$2
mapfile -t scenes < <(printf '%s\n' "${SCENES:-.}" | sed '/^[[:space:]]*$/d')
size=${SIZE:-256}
mkdir -p "$out"

# A line for the page of the run, where there is one.
summary() {
    printf '%s\n' "$*" >>"${GITHUB_STEP_SUMMARY:-/dev/null}"
}

# What stands for itself in HTML.
escaped() {
    sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'
}

check() {
    # The exit code is that of the annotations; the same findings go into a file.
    rtc check --message-format sarif -- "${scenes[@]}" >"$out/rtc.sarif" || true
    rtc check --message-format github -- "${scenes[@]}"
}

thumbnails() {
    mkdir -p "$out/thumbnails"
    rtc render -q --size "$size" -o "$out/thumbnails/" --contact-sheet "$out/sheet.png" -- "${scenes[@]}"
}

# The scenes here in whose folder, or below it, something differs from the base.
changed() {
    local changed scene
    changed=$(git diff --name-only "$BASE" --)
    git ls-files -- "${scenes[@]}" | grep -E '\.(yaml|yml|json|gltf|glb|rtir|obj|stl|ply|off)$' | while read -r scene; do
        local folder=${scene%/*}/
        [[ $scene == */* ]] || folder=
        # A scene in the root is compared if it changed itself, or a file beside it.
        if [[ -n $folder ]]; then
            grep -qF -- "$folder" <<<"$changed" && printf '%s\n' "$scene"
        else
            grep -qv / <<<"$changed" && printf '%s\n' "$scene"
        fi
    done || true
}

compare() {
    local page scene said name
    # Known to the trap, which outlives this function.
    before=$(mktemp -d)
    git worktree add --quiet --detach "$before" "$BASE"
    trap 'git worktree remove --force "$before"' EXIT
    mkdir -p "$out/compare"
    page=$out/compare/index.html
    printf '<!DOCTYPE html>\n<meta charset="utf-8">\n<title>What changed</title>\n<h1>What changed</h1>\n' >"$page"
    while read -r scene; do
        name=${scene//\//__}
        if [[ ! -e $before/$scene ]]; then
            said="new"
        elif said=$(rtc diff --size "$size" --html "$out/compare/$name.html" -- "$scene" "$before/$scene" 2>&1); then
            # What is the same has no page.
            [[ $said == *"no difference"* && $said == *"scenes are alike"* ]] && rm "$out/compare/$name.html" && continue
        fi
        if [[ -e $out/compare/$name.html ]]; then
            printf '<h2><a href="%s.html">%s</a></h2>\n' "$name" "$scene"
        else
            printf '<h2>%s</h2>\n' "$scene"
        fi >>"$page"
        printf '<pre>%s</pre>\n' "$(escaped <<<"${said//"$before/"/}")" >>"$page"
        summary "- \`$scene\`: $(grep -E '^rmse' <<<"$said" || head -n 1 <<<"$said")"
    done < <(changed)
}

"$what"
