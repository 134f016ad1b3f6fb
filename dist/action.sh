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

# Without characters that command a terminal or turn a line round, which a name may have.
clean() {
    LC_ALL=C tr -d '\000-\010\013\014\016-\037\177' | LC_ALL=C sed 's/\xe2\x80[\x8e\x8f\xaa-\xae]//g; s/\xe2\x81[\xa6-\xa9]//g; s/\xc2[\x80-\x9f]//g'
}

# What stands for itself in HTML, also within quotes.
escaped() {
    clean | sed "s/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g; s/\"/\&quot;/g; s/'/\&#39;/g"
}

# What stands for itself on a line of Markdown: names are those of strangers.
plain() {
    clean | tr '\n\r\t' '   ' | sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g; s/\\/\&#92;/g; s/`/\&#96;/g; s/\*/\&#42;/g; s/_/\&#95;/g
        s/\[/\&#91;/g; s/]/\&#93;/g; s/!/\&#33;/g; s/|/\&#124;/g; s/~/\&#126;/g; s/@/\&#64;/g; s/:/\&#58;/g'
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

# The scenes here in whose folder, or below it, something differs from the base, each with a NUL behind it. Links are none: they may
# lead anywhere.
changed() {
    local file folder scene
    local -A folders=()
    while IFS= read -r -d '' file; do
        folder=$file
        # A scene in the root is compared if it changed itself, or a file beside it.
        [[ $file == */* ]] || folders[.]=1
        while [[ $folder == */* ]]; do
            folder=${folder%/*}
            folders[$folder]=1
        done
    done < <(git diff --name-only -z "$BASE" --)
    while IFS= read -r -d '' scene; do
        [[ $scene =~ \.(yaml|yml|json|gltf|glb|rtir|xml|pbrt|pbrt\.gz|usd|usda|usdc|usdz|obj|stl|ply|off)$ && ! -L $scene ]] || continue
        folder=.
        [[ $scene != */* ]] || folder=${scene%/*}
        [[ -z ${folders[$folder]:-} ]] || printf '%s\0' "$scene"
    done < <(git ls-files -z -- "${scenes[@]}")
}

compare() {
    local page scene said shown number=0
    # Known to the trap, which outlives this function.
    before=$(mktemp -d)
    git worktree add --quiet --detach "$before" "$BASE"
    trap 'git worktree remove --force "$before"' EXIT
    mkdir -p "$out/compare"
    page=$out/compare/index.html
    cat >"$page" <<'HTML'
<!DOCTYPE html>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>What changed</title>
<style>
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 60rem; padding: 1rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; }
pre { white-space: pre-wrap; }
img { max-width: min(100%, 16rem); height: auto; }
</style>
<h1>What changed</h1>
HTML
    while IFS= read -r -d '' scene; do
        # Pages have numbers: a name may be too long for one, or that of another.
        number=$((number + 1))
        if [[ ! -e $before/$scene || -L $before/$scene ]]; then
            said="new"
        elif said=$(rtc diff --size "$size" --html "$out/compare/$number.html" -- "$scene" "$before/$scene" 2>&1); then
            # What is the same has no page.
            [[ $said == *"no difference"* && $said == *"scenes are alike"* ]] && rm "$out/compare/$number.html" && continue
        fi
        said=${said//"$before/"/}
        rtc render -q --size "$size" -o "$out/compare/$number.png" -- "$scene" 2>/dev/null || rm -f "$out/compare/$number.png"
        shown=$(escaped <<<"$scene")
        if [[ -e $out/compare/$number.html ]]; then
            printf '<h2><a href="%s.html">%s</a></h2>\n' "$number" "$shown"
        else
            printf '<h2>%s</h2>\n' "$shown"
        fi >>"$page"
        [[ ! -e $out/compare/$number.png ]] || printf '<img alt="new picture" src="%s.png">\n' "$number" >>"$page"
        printf '<pre>%s</pre>\n' "$(escaped <<<"$said")" >>"$page"
        said=$(grep -m 1 -E '^rmse' <<<"$said" || head -n 1 <<<"$said")
        summary "- $(plain <<<"$scene"): $(plain <<<"$said")"
    done < <(changed)
}

"$what"
