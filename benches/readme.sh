#!/usr/bin/env bash
# Runs each command that the README and the book show, in `release`, and replaces the output that
# they show. Between cuts, `…`, it looks for lines of the same form; if there are none, it puts in
# the whole output, to be cut by hand.
. "$(dirname "$0")/driver.sh"
RTC_UPDATE=1 cargo test --quiet --release --test suites readme::the_readme_and_the_book -- \
    --nocapture
git diff --stat README.md docs/book
