# SPDX-License-Identifier: Apache-2.0
"""Tests the page of a report on stored JSON, without running anything."""
import html.parser
import importlib.util
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

HERE = pathlib.Path(__file__).resolve().parent
TOOLS = HERE.parent.parent / "tools/report"
sys.path.insert(0, str(TOOLS))
program = importlib.util.module_from_spec(
    spec := importlib.util.spec_from_file_location("report", TOOLS / "__main__.py"))
spec.loader.exec_module(program)

MAX_WORDS = 3500
VOID = {"meta", "link", "img", "br"}


class Reader(html.parser.HTMLParser):
    """Collects the texts, the marked numbers, and what the page would load."""

    def __init__(self):
        super().__init__()
        self.open, self.texts, self.numbers, self.loads = [], [], [], []
        self.ids = []

    def handle_starttag(self, tag, attrs):
        of = dict(attrs)
        self.ids += [of["id"]] if "id" in of else []
        self.loads += [v for k, v in attrs if k in ("src", "href", "xlink:href", "data")]
        if tag not in VOID:
            self.open.append((tag, of))

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_data(self, text):
        tags = [tag for tag, _ in self.open]
        if not text.strip() or "body" not in tags:
            return
        if "data" in tags:
            of = self.open[-1][1]
            self.numbers.append((of["value"], of["data-at"], text))
        self.texts.append((tags, text))


def texts_in(value):
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list)):
        for one in value.values() if isinstance(value, dict) else value:
            yield from texts_in(one)
        if isinstance(value, dict):
            yield from value


def measurements(document):
    """Yields those of all scenes of all runs."""
    for run in document["runs"]:
        for scene in run["result"]["scenes"]:
            yield from scene["measurements"]


def at(tree, pointer):
    for part in pointer.strip("/").split("/"):
        tree = tree[int(part)] if isinstance(tree, list) else tree[part]
    return tree


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        for path in (HERE / "stored").glob("*.json"):
            shutil.copy(path, cls.folder)
        subprocess.run([sys.executable, "-B", TOOLS, cls.folder], check=True, timeout=300)
        cls.html, cls.tree = cls.read(cls.folder)
        cls.page = Reader()
        cls.page.feed(cls.html)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @staticmethod
    def read(folder):
        return ((folder / "index.html").read_text(), json.loads((folder / "page.json").read_text()))

    def make(self, folder=None, **more):
        """Makes the page without plots, which take most of the time."""
        import draw
        with unittest.mock.patch.object(draw, "Panel", unittest.mock.MagicMock()):
            program.make(folder or self.folder, **more)
        return self.read(folder or self.folder)

    def refusal(self, **more):
        import data
        with self.assertRaises(data.Problem) as caught:
            self.make(**more)
        return str(caught.exception)

    def change(self, name, change):
        """Changes a stored file for one test."""
        path = self.folder / f"{name}.json"
        before = path.read_text()
        self.addCleanup(path.write_text, before)
        document = json.loads(before)
        change(document)
        path.write_text(json.dumps(document))

    def prose(self):
        return [(tags, text) for tags, text in self.page.texts if "svg" not in tags]

    def test_every_number_is_in_its_json(self):
        self.assertGreater(len(self.page.numbers), 200)
        for value, place, shown in self.page.numbers:
            stored = at(self.tree, place.removeprefix("page.json#"))
            self.assertEqual(json.loads(value), stored, place)
            self.assertAlmostEqual(float(shown.replace(",", "")), stored, msg=place,
                                   delta=0.006 * abs(stored))

    def test_no_other_number_stands_on_the_page(self):
        known = set(re.findall(r"\S+", " ".join(texts_in(self.tree))))
        known |= {word.strip("(),.;:") for word in known}
        figures = re.compile(r"Figures? [\d., ]+|table [\d.]+|^[\d., ]+$")
        for tags, text in self.prose():
            if "data" in tags or "code" in tags:
                continue
            for word in figures.sub("", text).split():
                word = word.strip("(),.;:")
                if re.search(r"\d", word):
                    self.assertIn(word, known, text)

    def test_is_short(self):
        count = sum(len(text.split()) for _, text in self.prose())
        self.assertLessEqual(count, MAX_WORDS)

    def test_the_first_words_answer_what_a_reader_asks(self):
        first = " ".join(" ".join(text for _, text in self.prose()).split()[:400])
        for question in ("Who is fastest?", "Who is exact?", "What does a budget cost?",
                         "What was left out?", "On which machine?"):
            answer = first.partition(question)[2]
            self.assertTrue(answer, question)
            self.assertNotIn("not measured", answer[:60], question)
        self.assertIn(self.tree["about"]["processor"], first)
        self.assertIn(self.tree["error"]["budget"]["scene"], first)

    def test_the_scoreboard_has_ten_lines_that_lead_to_sections(self):
        board = self.html[self.html.index('class="score"'):self.html.index("<nav>")]
        sections = re.findall(r'<td><a href="#([\w-]+)">', board)
        self.assertEqual(len(sections), 10)
        self.assertLessEqual(set(sections), set(self.page.ids))
        order = re.findall(r'<section id="([\w-]+)">', self.html)
        self.assertEqual(order[:7], ["scoreboard", "error", "stiff", "left-out", "growth", "memory",
                                     "machines"])

    def test_says_where_a_peer_wins(self):
        def slow(document):
            for m in measurements(document):
                if m["contender"].startswith("embree-robust"):
                    seconds = m["call_seconds"]
                    seconds["samples"] = [1e-9 for _ in seconds["samples"]]
        self.change("error", slow)
        text, tree = self.make()
        self.assertEqual(tree["error"]["wins"], 0)
        self.assertIn("Embree robust: the peer wins", re.sub("<[^>]*>", "", text))
        self.assertEqual(tree["scoreboard"]["primary"]["verdict"], "misses")

    def test_a_peer_that_only_breaks_ties_has_none_wrong(self):
        def tie(document):
            for m in measurements(document):
                if m["contender"].startswith("embree"):
                    m.update(differ=m["rays"], tied=m["rays"], wrong=0, beside=0, leaked=0)
        self.change("error", tie)
        tree = self.make()[1]
        for scene in tree["error"]["scenes"]:
            for workload in scene["workloads"]:
                for one in workload["contenders"]:
                    if one["family"] == "embree" and one["tied"] is not None:
                        self.assertEqual((one["wrong"], one["tied"]), (0, 1e6))

    def test_a_wrong_answer_is_seen_on_the_scoreboard(self):
        def break_it(document):
            document["runs"][0]["result"]["scenes"][0]["measurements"][0]["wrong"] = 7
            document["runs"][0]["trouble"] = "seven are wrong"
        self.change("error", break_it)
        text, tree = self.make()
        self.assertEqual(tree["scoreboard"]["exact"]["verdict"], "misses")
        self.assertEqual(round(tree["scoreboard"]["exact"]["median"]), 7)
        self.assertIn("seven are wrong", text)

    def test_names_the_bars_that_do_not_hold(self):
        def add(document):
            bars = [{"line": f"call of {name}", "measured": 0.7, "low": 0.6, "high": 0.8,
                     "at_least": 0.85, "better": better, "verdict": verdict}
                    for name, better, verdict in (("one", "more", "failed"),
                                                  ("two", "less", "passed"),
                                                  ("three", "less", "too noisy"),
                                                  ("four", "more", "skipped"))]
            document["runs"].append({**document["runs"][0], "key": "bars",
                                     "result": {"bars": bars}})
        self.change("programs", add)
        text, tree = self.make()
        self.assertEqual([bar["verdict"] for bar in tree["error"]["bars"]],
                         ["misses", "holds", "too noisy"])
        self.assertEqual([f"call of {name}" in text for name in ("one", "two", "three", "four")],
                         [True, False, True, False])

    def test_marks_what_was_noisy(self):
        def set_quiet(quiet):
            def change(document):
                for run in document["runs"]:
                    run["quiet"] = quiet
            return change
        self.change("error", set_quiet(False))
        self.assertIn("noisy</td>", self.make()[0])
        self.change("error", set_quiet(True))
        self.assertTrue(self.make()[1]["scoreboard"]["primary"]["quiet"])

    def test_the_projection_is_never_below_what_was_measured(self):
        rows = [s for s in self.tree["growth"]["sweeps"] if s["over"] == "triangles"][0]["columns"]
        for projected in self.tree["growth"]["projection"]:
            for column in rows:
                measured = max(y for _, y in column["points"])
                self.assertGreaterEqual(projected[column["name"]]["low"], measured)
        for row in self.tree["machines"]["projection"]:
            self.assertGreaterEqual(row["seconds"], row["measured_rate_seconds"])

    def test_loads_nothing_and_draws_text(self):
        for address in self.page.loads:
            self.assertTrue(address.startswith(("#", "data:")), address)
        self.assertNotRegex(self.html, r"@import|url\((?!#)|<script")
        self.assertGreater(self.html.count("<svg"), 15)
        self.assertIn("<text", self.html)
        self.assertEqual(len(self.page.ids), len(set(self.page.ids)))

    def test_names_are_shown_as_they_are(self):
        import draw
        for name in ('a"b<i>&c', "$x^{2$", r"\1\g<0>"):
            panel = draw.Panel("names", name)
            panel.points(0, name, [(1, 1)])
            panel.legend()
            svg = panel.svg()
            self.assertEqual(html.unescape(re.search('aria-label="([^"]*)"', svg)[1]), name)
            reader = Reader()
            reader.feed(f"<body>{svg}</body>")
            self.assertEqual([text for _, text in reader.texts].count(name), 2)

    def test_compares_two_reports(self):
        with tempfile.TemporaryDirectory() as name:
            other = pathlib.Path(name)
            for path in (HERE / "stored").glob("*.json"):
                shutil.copy(path, other)
            document = json.loads((other / "error.json").read_text())
            for m in document["runs"][0]["result"]["scenes"][0]["measurements"]:
                m["call_seconds"]["samples"] = [10 * s for s in m["call_seconds"]["samples"]]
            (other / "error.json").write_text(json.dumps(document))
            tree = self.make(other=name)[1]
        changed = tree["compare"]["changed"]
        scene = tree["error"]["scenes"][0]["scene"]
        self.assertTrue(changed)
        for row in changed:
            self.assertTrue(row["name"].startswith(scene), row)
            self.assertAlmostEqual(row["percent"], -90, delta=1)

    def test_adds_what_a_kit_brought_back(self):
        kit = {"kit": "0.1", "system": "Linux", "failures": 1, "parts": [
            {"name": "kernels", "exit": 0, "seconds": 1, "text": "", "json":
             json.loads((HERE / "stored/error.json").read_text())["runs"][0]["result"]}]}
        for part in kit["parts"][0]["json"]["scenes"][0]["measurements"]:
            part["kernel_seconds"] = None
        path = self.folder / "kit"
        path.write_text(json.dumps(kit))
        text, tree = self.make(kit=path)
        self.assertIn('<section id="gpu">', text)
        self.assertEqual(tree["gpu"]["failures"], 1)
        self.assertIn("is no kit.json", self.refusal(kit=self.folder / "page.json"))

    def test_refuses_what_it_cannot_read(self):
        path = self.folder / "error.json"
        self.addCleanup(path.write_text, path.read_text())
        path.write_text('{"experiment": "error", "schema": "overcast-report-0"}')
        self.assertIn("overcast-report-0", self.refusal())
        path.write_text("{")
        self.assertIn("error.json is no JSON", self.refusal())

    def test_has_a_page_of_one_experiment_alone(self):
        with tempfile.TemporaryDirectory() as name:
            for path in sorted((HERE / "stored").glob("*.json")):
                folder = pathlib.Path(name) / path.stem
                folder.mkdir()
                shutil.copy(path, folder)
                program.make(folder)
                self.assertIn(f"--only {path.stem} ", self.read(folder)[0])


if __name__ == "__main__":
    for package in ("matplotlib", "jinja2"):
        try:
            __import__(package)
        except ImportError:
            print(f"python3-{package} is not installed")
            sys.exit(77)
    unittest.main()
