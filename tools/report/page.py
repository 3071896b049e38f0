# SPDX-License-Identifier: Apache-2.0
"""What a page is made of, and how its numbers say where they come from."""
import base64
import dataclasses
import json
import math
import pathlib

import jinja2
from markupsafe import Markup, escape

HERE = pathlib.Path(__file__).parent


@dataclasses.dataclass
class Table:
    title: str
    header: list
    rows: list


@dataclasses.dataclass
class Picture:
    caption: str
    address: str


@dataclasses.dataclass
class Section:
    """One claim, one figure of some panels or pictures, tables, and how to measure again."""
    id: str
    title: str
    claim: str
    caption: str = ""
    panels: list = dataclasses.field(default_factory=list)
    pictures: list = dataclasses.field(default_factory=list)
    tables: list = dataclasses.field(default_factory=list)
    again: list = dataclasses.field(default_factory=list)
    load: str = ""


def shown(value):
    """A number as the page has it: three digits, or all of a whole number below a billion."""
    if value == 0:
        return "0"
    if value == int(value) and abs(value) < 1e9:
        return f"{int(value):,}"
    if abs(value) >= 1e6 or abs(value) < 1e-3:
        return f"{value:.3g}".replace("e+0", "e").replace("e-0", "e-").replace("e+", "e")
    if abs(value) >= 1000:
        return f"{round(value):,}"
    text = f"{value:.{max(0, 2 - math.floor(math.log10(abs(value))))}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


class Figures:
    """All figures of the page, which page.json holds; texts take their numbers from here."""

    def __init__(self, tree):
        self.tree = tree

    def at(self, *path):
        node = self.tree
        for part in path:
            if node is None:
                return None
            node = node[part]
        return node

    def n(self, *path, unit=""):
        """The number at this place, marked with it; a dash where there is none."""
        value = self.at(*path)
        if value is None or (isinstance(value, float) and not math.isfinite(value)):
            return Markup("–")
        pointer = "".join(f"/{part}" for part in path)
        return Markup('<data value="{}" data-at="page.json#{}">{}</data>{}').format(
            json.dumps(value), pointer, shown(value), unit)

    def range(self, *path, low="low", high="high"):
        """The spread at this place: "1.1 to 1.3"."""
        if self.at(*path) is None or self.at(*path, low) is None:
            return Markup("–")
        return self.n(*path, low) + " to " + self.n(*path, high)


def words(pieces):
    """Joins texts, of which some are marked up."""
    return Markup("").join(escape(piece) for piece in pieces)


def listed(items):
    """a, b and c."""
    items = [escape(item) for item in items]
    if len(items) < 2:
        return Markup("").join(items)
    return Markup(", ").join(items[:-1]) + " and " + items[-1]


def picture(path, caption):
    bytes_ = base64.b64encode(pathlib.Path(path).read_bytes()).decode()
    return Picture(caption, "data:image/png;base64," + bytes_)


def render(**parts):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True,
                                     undefined=jinja2.StrictUndefined)
    style = Markup((HERE / "page.css").read_text().strip())
    return environment.get_template("page.html.j2").render(style=style, **parts) + "\n"
