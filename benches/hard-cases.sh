#!/usr/bin/env bash
# How hard cases fare, as a page in Markdown: errors of t against double-double, and counts of
# leaks, false self-hits, gaps not seen and boxes missed. Fails if a value is not as it must be.
# `hard-cases.sh [RAYS]`: rays of each row (10⁶). `benches/hard-cases.sh 32000000
# >benches/hard-cases.md` writes the page: 10⁸ rays and more of each kind.
. "$(dirname "$0")/driver.sh"
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

# `rows GROUP [NAME=TEXT...]`: the rows of a table, each with the text of the longest name that its
# own begins with: what other renderers reach there.
rows() {
    local group=$1
    shift
    awk -F ' *[|] *' -v group="$group" -v others="$(printf '%s;' "$@")" '
        BEGIN {
            count = split(others, parts, ";")
            for (k = 1; k <= count; k++) { split(parts[k], pair, "="); other[pair[1]] = pair[2] }
        }
        $2 == group {
            said = ""
            for (name in other) {
                if (index($3, name) == 1 && length(name) > length(said)) said = name
            }
            row = "|"
            for (k = 3; k < NF; k++) row = row " " $k " |"
            print row " " (said == "" ? "" : other[said]) " |"
            rays += $4; counted += $5
        }
        END { if (group != "truth") printf "| all | %.0f | %d | |\n", rays, counted }' "$out"
}

cat <<END
# Hard cases

Rays that are difficult for the arithmetic of a renderer. \`benches/hard-cases.sh $RTC_RAYS\` writes
this page; the table was measured on two cores of an AMD EPYC (Zen 3). u = 2⁻⁵³ is the unit roundoff
of f64. The last column shows what other formulas reach. They were measured on ports to f64 where
nothing else is stated; Embree's leaks and Mitsuba's self-hits were measured on the programs
themselves.

$STATE

## Errors of t

t is the distance to the hit, κ its condition number. The reference is computed in double-double.
The gates are:

- no hit is missed where κ < 1/(64 u), and none is invented;
- the error is at most 2 u·(1 + κ);
- for spheres and planes the error is at most 64 u, whatever κ is.

| family | rays | missed | invented | worst, u | worst, u·(1 + κ) | others |
| --- | --: | --: | --: | --: | --: | --- |
END
rows truth \
    'sphere generic=Mitsuba 1.0, Cycles 2.0 u·(1 + κ), pbrt in f32 8.8' \
    'sphere far_small=pbrt in f32 misses 28 %, b² − 4ac 18 %' \
    'sphere huge_near=Cycles 2.9·10⁶ u (median)' \
    'sphere grazing=pbrt in f32 misses 32 %' \
    'sphere inside=Mitsuba 7.5·10⁴ u' \
    'triangle sliver=Embree 6.4·10⁷, Möller–Trumbore (Mitsuba) 2.5·10⁹, pbrt 1.2 u·(1 + κ)' \
    'plane offset1e8=N·o − N·c (course) 1.5·10⁸ u' \
    'plane near_parallel=the course misses slopes below 10⁻⁴' \
    'cylinder thin_far=quadratic from the eye 1.5·10⁷ u·(1 + κ)' \
    'cone thin_far=quadratic from the eye 2.6·10⁶ u·(1 + κ)' \
    'torus far=Ferrari 6.6·10¹¹ u·(1 + κ), misses 21 %' \
    'torus grazing=sphere tracing misses 73 %'
cat <<END

## Leaks

Rays start inside a closed mesh of 1 280 triangles. They aim at vertices and edges in turn; every
eighth has a random direction. A ray that hits nothing is a leak.

| mesh | rays | leaks | others |
| --- | --: | --: | --- |
END
embree='Embree, robust, 7·10⁻⁶ … 1.8·10⁻³ at vertices, Möller–Trumbore (Mitsuba) 10⁻³ … 10⁻¹'
rows leaks "triangles=$embree" 'triangles, displaced=pbrt 3·10⁻⁶ at edges' \
    'triangles, radius 1e-6=pbrt 1'
cat <<END

## False self-hits

Rays leave a surface at a cosine of 10⁻⁶ … 1 to the normal. Shapes have sizes of 10⁻⁶ … 10⁸ and lie
up to 10⁸ from the origin. A hit of the same point is false.

| shape | rays | false hits | others |
| --- | --: | --: | --- |
END
rows 'false self-hits' 'sphere=Mitsuba in f32 1.7·10⁻⁴' 'cylinder=Mitsuba in f32 1.8·10⁻⁴' \
    "torus=pbrt's bound 3·10⁻⁴, integer offset 1.4·10⁻⁴" \
    'plane=t > 10⁻⁵ (course) 0.2 … 0.5 at 10⁸'
cat <<END

## Gaps

Rays pass through a surface with a second one behind it, at 10⁻¹³ of its size. Sizes are 10⁻⁶ … 10⁸.

| shape | rays | second surface not seen | others |
| --- | --: | --: | --- |
END
seen="smallest gap seen at all sizes: Mitsuba's rule 1.8·10⁻⁷, integer offset 3·10⁻⁸, course none"
rows 'gaps not seen' "sphere=$seen"
cat <<END

## Boxes

Rays hit a triangle, inside, at an edge and at a corner in turn. The third column counts the rays
that miss its bounding box.

| box | hits | boxes missed | others |
| --- | --: | --: | --- |
END
rows 'boxes missed' "generic=slabs by minimum and maximum 1.8·10⁻², pbrt's and Ize's 0" \
    'flat box=slabs by minimum and maximum 4.0·10⁻²' \
    'ray in the plane=slabs by division 1' \
    'at 1e6=slabs by minimum and maximum 1.9·10⁻²'
