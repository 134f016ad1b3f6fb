#!/bin/sh
# Runs each command that the README and the book show, in release, and puts what it says in place of the lines shown. Between cuts, `…`,
# lines of the same form are looked for; where there are none all is put in, to be cut by hand.
set -eu
cd "$(dirname "$0")/.."
RTC_UPDATE=1 cargo test --quiet --release --test suites readme::the_readme_and_the_book -- --nocapture
git diff --stat README.md docs/book
