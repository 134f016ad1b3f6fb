#!/usr/bin/env bash
# How hard cases fare, as Markdown: errors of t against double-double, and counts of leaks, false self-hits, gaps not seen
# and boxes missed. The argument is the number of rays of each row, 10⁶ by default. Fails where anything is not as it must
# be. `benches/hard-cases.sh 32000000 >benches/hard-cases.md` makes the table that is kept: 10⁸ rays and more of each kind.
set -euo pipefail
cd "$(dirname "$0")/.."
export RTC_RAYS="${1:-1000000}"
out=$(mktemp)
trap 'rm -f "$out"' EXIT

run() {
    cargo test --quiet --release "$@" -- --nocapture --test-threads 1 >>"$out" 2>&1 || {
        cat "$out" >&2
        exit 1
    }
}
run --test suites hardcases::families::our_own
run --test suites hardcases::leaks::closed
run --test suites hardcases::leaks::placed
run --test suites hardcases::self_hits
run --test suites hardcases::gaps
run --lib no_box_is_missed

# Rows of one table: those of a group, each with what others reach there.
rows() {
    awk -F ' *[|] *' -v group="$1" -v others="$2" '
        BEGIN {
            count = split(others, parts, ";")
            for (k = 1; k <= count; k++) { split(parts[k], pair, "="); other[pair[1]] = pair[2] }
        }
        $2 == group {
            said = ""
            for (name in other) if (index($3, name) == 1 && length(name) > length(said)) said = name
            row = "|"
            for (k = 3; k < NF; k++) row = row " " $k " |"
            print row " " (said == "" ? "" : other[said]) " |"
            rays += $4; counted += $5
        }
        END { if (group != "truth") printf "| all | %.0f | %d | |\n", rays, counted }' "$out"
}

cat <<END
# Hard cases

\`benches/hard-cases.sh $RTC_RAYS\`, on two cores of an AMD EPYC (Zen 3); u = 2⁻⁵³. The last column is what other formulas
reach, measured on ports of them (leaks of Embree and self-hits of Mitsuba: on themselves); f64 where nothing else is said.

## Errors of t

κ is the condition number of t. Gates: no hit missed where κ < 1/(64 u), none invented, at most 2 u·(1 + κ), and for spheres
and planes at most 64 u whatever κ. The truth is double-double.

| family | rays | missed | invented | worst, u | worst, u·(1 + κ) | others |
| --- | --: | --: | --: | --: | --: | --- |
END
rows truth "sphere generic=Mitsuba 1.0, Cycles 2.0 u·(1 + κ), pbrt in f32 8.8;sphere far_small=pbrt in f32 misses 28 %, b² − 4ac 18 %;\
sphere huge_near=Cycles 2.9·10⁶ u (median);sphere grazing=pbrt in f32 misses 32 %;sphere inside=Mitsuba 7.5·10⁴ u;\
triangle sliver=Embree 6.4·10⁷, Möller–Trumbore (Mitsuba) 2.5·10⁹, pbrt 1.2 u·(1 + κ);plane offset1e8=N·o − N·c (course) 1.5·10⁸ u;\
plane near_parallel=the course misses slopes below 10⁻⁴;cylinder thin_far=quadratic from the eye 1.5·10⁷ u·(1 + κ);\
cone thin_far=quadratic from the eye 2.6·10⁶ u·(1 + κ);torus far=Ferrari 6.6·10¹¹ u·(1 + κ), misses 21 %;\
torus grazing=sphere tracing misses 73 %"
cat <<END

## Leaks

Rays from inside a closed mesh of 1 280 triangles, aimed at vertices and edges by turns, every eighth anywhere.

| mesh | rays | leaks | others |
| --- | --: | --: | --- |
END
others="Embree, robust, 7·10⁻⁶ … 1.8·10⁻³ at vertices, Möller–Trumbore (Mitsuba) 10⁻³ … 10⁻¹"
rows leaks "triangles=$others;triangles, displaced=pbrt 3·10⁻⁶ at edges;triangles, radius 1e-6=pbrt 1"
cat <<END

## False self-hits

Rays that leave a surface at a cosine of 10⁻⁶ … 1, sizes 10⁻⁶ … 10⁸, up to 10⁸ from the origin.

| shape | rays | false hits | others |
| --- | --: | --: | --- |
END
rows "false self-hits" "sphere=Mitsuba in f32 1.7·10⁻⁴;cylinder=Mitsuba in f32 1.8·10⁻⁴;torus=pbrt's bound 3·10⁻⁴, integer offset 1.4·10⁻⁴;\
plane=t > 10⁻⁵ (course) 0.2 … 0.5 at 10⁸"
cat <<END

## Gaps

Rays through a surface with another 10⁻¹³ of its size behind it, sizes 10⁻⁶ … 10⁸.

| shape | rays | second surface not seen | others |
| --- | --: | --: | --- |
END
rows "gaps not seen" "sphere=smallest gap seen at all sizes: Mitsuba's rule 1.8·10⁻⁷, integer offset 3·10⁻⁸, course none"
cat <<END

## Boxes

Rays that hit a triangle, aimed at inside, edge and corner by turns: how many pass its box by.

| box | hits | boxes missed | others |
| --- | --: | --: | --- |
END
rows "boxes missed" "generic=slabs by minimum and maximum 1.8·10⁻², pbrt's and Ize's 0;flat box=slabs by minimum and maximum 4.0·10⁻²;\
ray in the plane=slabs by division 1;at 1e6=slabs by minimum and maximum 1.9·10⁻²"
