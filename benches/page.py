"""Puts standard input into a page of this folder: `page.py PAGE NAME` replaces the lines of PAGE.md
between `<!-- NAME -->` and `<!-- end of NAME -->`."""

import pathlib
import sys

page, name = pathlib.Path(__file__).with_name(f"{sys.argv[1]}.md"), sys.argv[2]
begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
before, rest = page.read_text().split(begin)
page.write_text(
    before + begin + "\n" + sys.stdin.read().strip() + "\n\n" + end + rest.split(end)[1]
)
