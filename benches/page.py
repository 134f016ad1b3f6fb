"""Puts standard input into benches/README.md, between the lines `<!-- NAME -->` and `<!-- end of NAME -->`: `page.py NAME`."""
import pathlib
import sys

page = pathlib.Path(__file__).with_name("README.md")
begin, end = f"<!-- {sys.argv[1]} -->\n", f"<!-- end of {sys.argv[1]} -->\n"
before, rest = page.read_text().split(begin)
page.write_text(before + begin + "\n" + sys.stdin.read().strip() + "\n\n" + end + rest.split(end)[1])
