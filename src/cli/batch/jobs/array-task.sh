#!/bin/sh
# @TITLE@
# One task renders its part. Then it merges groups of @GROUP@, up to the picture, as long as all
# parts of a group are there: the task that finishes a group last does that. Files appear whole.
set -eu
cd "$(dirname "$0")"
rtc=${RTC:-rtc}
task=${JOB_COMPLETION_INDEX:-0}
part=$((task % @PARTS@ + 1))
frame=$(printf %04d $((task / @PARTS@ + @FIRST@)))

# The file of a node of the tree, by its level and its number there from 0.
node() {
    part=$(($2 + 1))
    case $1 in
    0) echo "@NAME@" ;;
    *) echo "merged-$frame-$1-$part.rtp" ;;
    esac
}

# What an earlier try has finished is not rendered again.
[ -e "@NAME@" ] || "$rtc" @PART@
level=0 index=$((part - 1)) count=@PARTS@
while :; do
    # The group of the node, if all of it is there.
    index=$((index / @GROUP@))
    other=$((index * @GROUP@)) end=$((index * @GROUP@ + @GROUP@))
    set --
    while [ $other -lt $end ] && [ $other -lt $count ]; do
        file=$(node $level $other)
        [ -e "$file" ] || exit 0
        set -- "$@" "$file"
        other=$((other + 1))
    done
    # The node above, or the picture.
    level=$((level + 1)) count=$(((count + @GROUP@ - 1) / @GROUP@))
    to=@PICTURE@
    [ $count -eq 1 ] || to=$(node $level $index)
    "$rtc" @MERGE@
    [ $count -ne 1 ] || exit 0
done
