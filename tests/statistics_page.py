# SPDX-License-Identifier: Apache-2.0
"""Fails unless docs/reference/stats.md lists ovc_statistics as plugin/overcast.h documents it.

usage: statistics_page.py ROOT [--write]     --write: puts them there
"""
import pathlib
import re
import sys

BEGIN = "<!-- made from plugin/overcast.h: python3 tests/statistics_page.py . --write -->\n"
END = "<!-- end -->\n"


def table(root):
    header = (root / "plugin/overcast.h").read_text()
    struct = re.search(r"typedef struct ovc_statistics \{(.*?)\} ovc_statistics;",
                       header, re.DOTALL)[1]
    stats = (root / "host/output/stats.cpp").read_text()
    places = dict(re.findall(r'\{"(\w+)", "/([\w/]+)"\}', stats))
    yield "| field of `ovc_statistics` | key in JSON | counts up | meaning |\n|---|---|---|---|\n"
    for comment, name in re.findall(r"/\*(.*?)\*/\s*(?:uint64_t|double) (\w+);", struct, re.DOTALL):
        meaning = re.sub(r"\s*\n\s*\* ", " ", comment).strip()
        counts_up = meaning.startswith("+ ")
        default = re.sub("^seconds_", "time/", re.sub("^dropped_", "dropped/", name))
        path = places.get(name) or default
        key = " of ".join(f"`{part}`" for part in reversed(path.split("/")))
        mark = "yes" if counts_up else ""
        yield f"| `{name}` | {key} | {mark} | {meaning.removeprefix('+ ')} |\n"


def main():
    root = pathlib.Path(sys.argv[1])
    page = root / "docs/reference/stats.md"
    text = page.read_text()
    before, _, rest = text.partition(BEGIN)
    expected = before + BEGIN + "\n" + "".join(table(root)) + "\n" + END + rest.partition(END)[2]
    if text == expected:
        return 0
    if sys.argv[2:] == ["--write"]:
        page.write_text(expected)
        return 0
    print(f"{page} does not tell of the fields of ovc_statistics as plugin/overcast.h does; "
          "python3 tests/statistics_page.py . --write makes it")
    return 1


if __name__ == "__main__":
    sys.exit(main())
