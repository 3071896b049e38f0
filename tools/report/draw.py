# SPDX-License-Identifier: Apache-2.0
"""Draws panels of figures as SVG whose text is text and whose colours are the page's."""
import html
import io
import math
import re

import matplotlib
import matplotlib.ticker
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

matplotlib.rcParams.update({
    "svg.fonttype": "none", "font.size": 9, "font.family": "sans-serif", "axes.titlesize": 9.5,
    "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False, "legend.fontsize": 8,
    "grid.linewidth": 0.6,
    "axes.edgecolor": "#010203", "axes.labelcolor": "#010203", "xtick.color": "#010203",
    "ytick.color": "#010203", "text.color": "#010203", "grid.color": "#040506"})

if "text.parse_math" in matplotlib.rcParams:  # since 3.6; names of scenes may have dollars
    matplotlib.rcParams["text.parse_math"] = False

# Colours that stand for variables of the page's style, which has them light and dark.
INK, GRID = "#010203", "#040506"
SERIES = [f"#0a0b{n:02x}" for n in range(8)]
STANDS_FOR = {INK: "var(--ink)", GRID: "var(--grid)",
              **{color: f"var(--s{n})" for n, color in enumerate(SERIES)}}
MARKS = "osD^vPX*"


def short(value, _=None):
    """A number as axes say it: 250, 4k, 10M, 2e-5."""
    if value == 0:
        return "0"
    for unit, name in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(value) >= unit:
            return f"{value / unit:.3g}{name}"
    return f"{value:.3g}".replace("e-0", "e-")


class Panel:
    """A small plot; several of them make a section's figure."""

    def __init__(self, name, title, x="", y="", size=(4.4, 3.0)):
        self.name, self.title = name, title
        self.figure = Figure(figsize=size, layout="constrained")
        FigureCanvasSVG(self.figure)
        self.axes = self.figure.add_subplot()
        self.axes.set_title(title)
        self.axes.set_xlabel(x)
        self.axes.set_ylabel(y)
        self.axes.grid(True, color=GRID)
        self.axes.set_axisbelow(True)

    def log(self, axis, floor=None):
        """Makes an axis logarithmic. With a floor, 0 is shown below it; points come first."""
        scale = getattr(self.axes, f"set_{axis}scale")
        if floor:
            scale("symlog", linthresh=floor, linscale=0.5)
        else:
            scale("log")
        of = getattr(self.axes, f"{axis}axis")
        of.set_major_formatter(short)
        of.set_minor_formatter(matplotlib.ticker.NullFormatter())
        if floor:
            limits = getattr(self.axes, f"set_{axis}lim")
            limits(-0.3 * floor, max(100 * floor, getattr(self.axes, f"get_{axis}lim")()[1]))
            top = getattr(self.axes, f"get_{axis}lim")()[1]
            steps = range(1 + int(math.log10(top / floor)))
            of.set_ticks([0] + [floor * 10 ** k for k in steps][::2 if len(steps) > 4 else 1][1:])
        return self

    def points(self, n, label, points, bars=None, line=False, filled=True):
        """bars: (low, high) of x for each point, drawn as the spread."""
        if not points:
            return
        xs, ys = zip(*points)
        if bars:
            below = [max(0, x - low) for x, (low, _) in zip(xs, bars)]
            above = [max(0, high - x) for x, (_, high) in zip(xs, bars)]
            self.axes.errorbar(xs, ys, xerr=(below, above), fmt="none", ecolor=SERIES[n],
                               elinewidth=0.9, alpha=0.7)
        self.axes.plot(xs, ys, MARKS[n], linestyle="-" if line else "none", color=SERIES[n],
                       markersize=5.5, linewidth=1.2, label=label,
                       markerfacecolor=SERIES[n] if filled else "none")

    def rows(self, labels, values, bars=None, n=0, log=False):
        """Horizontal bars, the first on top."""
        places = range(len(labels))
        error = None
        if bars:
            error = ([max(0, v - low) for v, (low, _) in zip(values, bars)],
                     [max(0, high - v) for v, (_, high) in zip(values, bars)])
        self.axes.barh(places, values, color=SERIES[n], height=0.6, xerr=error,
                       error_kw={"ecolor": INK, "elinewidth": 0.9})
        self.axes.set_yticks(list(places), labels)
        self.axes.invert_yaxis()
        if log:
            self.log("x")

    def ticks(self, places):
        """Ticks of x at these places alone, where they are few."""
        if len(set(places)) <= 8:
            self.axes.set_xticks(sorted(set(places)), [short(x) for x in sorted(set(places))])
            self.axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())

    def limit(self, x=None, y=None):
        draw = self.axes.axvline if x is not None else self.axes.axhline
        draw(x if x is not None else y, color=INK, linewidth=1, linestyle="--")

    def legend(self, columns=2):
        """Below the axes, where it hides nothing."""
        if self.axes.get_legend_handles_labels()[0]:
            self.axes.legend(loc="upper center", bbox_to_anchor=(0.45, -0.2), ncols=columns)

    def svg(self):
        """The panel without sizes of its own; ids begin with its name, as a page has many."""
        for of in (self.axes.xaxis, self.axes.yaxis):
            low, high = sorted(of.get_view_interval())
            if of.get_scale() == "log" and high < 30 * low and \
                    isinstance(of.get_major_locator(), matplotlib.ticker.LogLocator):
                of.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        text = io.StringIO()
        with matplotlib.rc_context({"svg.hashsalt": self.name}):
            self.figure.savefig(text, format="svg", transparent=True,
                                metadata={"Date": None, "Creator": None, "Type": None,
                                          "Format": None})
        svg = text.getvalue()
        svg = svg[svg.index("<svg"):]
        svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
        label = html.escape(self.title)
        svg = re.sub(r'<svg [^>]*viewBox="([^"]*)"[^>]*>', lambda found:
                     f'<svg viewBox="{found[1]}" role="img" aria-label="{label}">', svg, count=1)
        svg = re.sub(r'\bid="([^"]*)"', rf'id="{self.name}-\1"', svg)
        svg = re.sub(r'(url\(|href=")#', rf"\1#{self.name}-", svg)
        for color, variable in STANDS_FOR.items():
            svg = svg.replace(color, variable)
        return svg
