"""The documentation holds: links and anchors lead somewhere, equations that are cited exist, and the blocks of the pages do what they show.

Blocks by their first line: ```toml title="x.toml": a complete case, written to x.toml and checked. ```toml: the same without a name. ```toml fragment: a
part of a case, whose tables and keys must be in the schema. ```sh: lines that begin with `uplift` are run, in one folder for each page. ```sh fragment:
commands that need files of the reader. ```output: what the block before printed; `...` stands for anything. All others are not looked at."""

import shlex
import sys
import tomllib
import unicodedata

from support import *

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import make_docs  # noqa: E402
import make_verification  # noqa: E402

NEW_LAW = "src/uplift/laws/anchored.cpp"  # the file that the pages on a new law tell the reader to write
LANGUAGES = {"toml", "toml fragment", "sh", "sh fragment", "output", "text", "cpp", "python", "python fragment", "c"}


def blocks(text):
    """(first line after the fence, text, line number) of every fenced block."""
    for found in re.finditer(r"^```([^\n`]+)\n(.*?)^```$", text, re.M | re.S):
        yield found.group(1).strip(), found.group(2), text.count("\n", 0, found.start()) + 1


def prose(text):
    """The text without fenced and indented blocks and without code."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^    .*$", "", text, flags=re.M))


def slug(title):
    """The anchor that Python-Markdown gives a heading."""
    title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title).replace("`", "").replace("*", "")
    title = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode()
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", title).strip().lower())


def anchors(text):
    found = {slug(title) for title in re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S), re.M)}
    return found | {f"eq-{number}" for number in re.findall(r"\\tag\{(\w+)\}", text)}


def as_pattern(expected):
    """A regular expression of an output block: `...` is anything, runs of blanks are one."""
    parts = [re.sub(r"(\\ |\\\n|\n| )+", r"\\s+", re.escape(part.strip())) for part in expected.split("...")]
    return r"\s*" + r".*?".join(parts)


class Pages(CliTest):
    """All pages, the generated ones too."""

    @classmethod
    def setUpClass(cls):
        import tempfile
        cls.keep = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.keep.cleanup)
        cls.source = pathlib.Path(cls.keep.name) / "source"
        make_docs.pages(program(), None, cls.source)
        cls.pages = {path: path.read_text() for path in sorted(cls.source.rglob("*.md"))}

    def test_links_and_anchors(self):
        wrong, links = [], 0
        for path, text in self.pages.items():
            for target in re.findall(r"\]\(([^)\s]+)\)", prose(text)):
                if re.match(r"https?:", target):
                    continue
                links += 1
                name, _, anchor = target.partition("#")
                other = (path.parent / name).resolve() if name else path.resolve()
                if not other.exists():
                    wrong.append(f"{path.relative_to(self.source)}: {target}: no such page")
                elif anchor and anchor not in anchors(other.read_text()):
                    wrong.append(f"{path.relative_to(self.source)}: {target}: no such anchor")
        self.assertEqual(wrong, [])
        self.assertGreater(links, 150)

    def test_every_page_is_in_the_navigation(self):
        listed = make_docs.navigation((ROOT / "docs" / "mkdocs.yml").read_text(), self.source)
        matrix = (self.source / "verification" / "index.md").read_text()
        for path in self.pages:
            if path.parent.name == "verification" and path.name != "index.md":
                self.assertIn(f"({path.name})", matrix)
            else:
                self.assertIn(str(path.relative_to(self.source)), listed)
        for page in re.findall(r"[\w/-]+\.md", listed):
            self.assertTrue((self.source / page).exists(), page)

    def test_the_verification_manual_has_a_page_for_every_case(self):
        cases = make_verification.declared()  # ends with an error where a test does not state requirement, title and source
        self.assertGreaterEqual(len(cases), 100)
        for case in cases.values():
            self.assertTrue(all(case[key] for key in ("requirement", "title", "source")), case["id"])
            self.assertIn(case["title"], (self.source / "verification" / f"{case['id']}.md").read_text())

    def test_figures_of_a_run_are_on_the_pages(self):
        record = self.folder / "record"
        record.mkdir()
        row = {"quantity": "moment", "unit": "N m", "comparison": "near", "measured": 1.0004, "reference": 1, "tolerance": 0.001, "count": 7}
        (record / "a.json").write_text(json.dumps({"suite": "Footing", "name": "TwoSprings", "passed": True, "rows": [row]}))
        make_verification.write_manual(record, self.folder / "manual")
        self.assertIn("| moment | N m | 1 | 1.0004 | 0.001 | 7 |", (self.folder / "manual" / "Footing.TwoSprings.md").read_text())
        matrix = (self.folder / "manual" / "index.md").read_text()
        self.assertRegex(matrix, r"Footing on two springs\]\(Footing.TwoSprings.md\) \| 1 \| passed")
        self.assertRegex(matrix, r"Footing.WinklerStrip.md\) \|   \| not run")

    def test_files_named_in_the_text_exist(self):
        for path, text in self.pages.items():
            for name in re.findall(r"`((?:docs|src|tests|examples|scripts|bench)/[\w./-]+\.(?:md|cpp|h|py|toml|json))`", text):
                if name != NEW_LAW:
                    self.assertTrue((ROOT / name).exists(), f"{path.relative_to(self.source)}: {name}")

    def test_equations_that_are_cited_exist(self):
        known = {number: path for path, text in self.pages.items() for number in re.findall(r"\\tag\{(\w+)\}", text)}
        self.assertTrue({"1", "13a", "44", "F1", "T3", "G2"} <= set(known))
        cited = 0
        for path, text in self.pages.items():
            numbers = re.findall(r"docs/theory(?:/README\.md)?,? eqs? \(?(\w+)\)?", text) + re.findall(r"\beqs? \((\w+)\)", text)
            if path.parent.name == "theory":
                numbers += re.findall(r"(?<![\w)])\(([FTG]?\d{1,2}[a-z]?)\)", re.sub(r"paper[^.;]*|\b[A-Z]\w+ \d+ \(\d+\)", "", prose(text)))
            for number in numbers:
                cited += 1
                self.assertIn(number, known, f"{path.relative_to(self.source)} cites equation ({number})")
        self.assertGreater(cited, 30)

    def test_equations_have_one_number_each(self):
        numbers = [number for path, text in self.pages.items() if path.parent.name == "theory" for number in re.findall(r"\\tag\{(\w+)\}", text)]
        self.assertEqual(len(numbers), len(set(numbers)))

    def test_messages_that_are_explained_are_those_of_the_program(self):
        sources = "".join(path.read_text() for path in sorted((ROOT / "src").rglob("*.[ch]*")))
        joined = re.sub(r'"\s*\n\s*"', "", sources).replace('\\"', '"')
        for quoted in re.findall(r'^\| "(.+?)" \|', (ROOT / "docs/guide/troubleshooting.md").read_text(), re.M):
            self.assertIn(quoted, joined)


class Blocks(CliTest):
    PAGES = sorted((ROOT / "docs").rglob("*.md")) + [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]

    def test_every_block_says_what_it_is(self):
        for page in self.PAGES:
            for head, _, line in blocks(page.read_text()):
                self.assertIn(re.sub(r' title="[^"]*"', "", head), LANGUAGES, f"{page.relative_to(ROOT)}:{line}")

    def test_fragments_use_keys_of_the_schema(self):
        schema, seen = json.loads(self.uplift("schema").stdout), 0
        for page in self.PAGES:
            for head, text, line in blocks(page.read_text()):
                if head == "toml fragment":
                    seen += 1
                    self.keys_exist(tomllib.loads(text), [schema], f"{page.relative_to(ROOT)}:{line}")
        self.assertGreater(seen, 15)

    def keys_exist(self, value, schemas, where):
        """Every key of the value is a property of one of the schemas, or of one of their alternatives."""
        schemas = list(schemas)
        for schema in schemas:
            schemas += schema.get("anyOf", []) + schema.get("oneOf", []) + schema.get("allOf", [])
        if isinstance(value, dict):
            for key, inner in value.items():
                fitting = [schema["properties"][key] for schema in schemas if key in schema.get("properties", {})]
                fitting = fitting or [schema["additionalProperties"] for schema in schemas if isinstance(schema.get("additionalProperties"), dict)]
                self.assertTrue(fitting, f"{where}: {key} is no key of the case file")
                self.keys_exist(inner, fitting, f"{where} {key}")
        elif isinstance(value, list):
            for inner in value:
                self.keys_exist(inner, [schema["items"] for schema in schemas if "items" in schema], where)

    def test_cases_and_commands_do_what_the_pages_show(self):
        ran = 0
        for page in self.PAGES:
            folder, printed = self.folder / page.stem, ""
            folder.mkdir(exist_ok=True)
            for head, text, line in blocks(page.read_text()):
                where = f"{page.relative_to(ROOT)}:{line}"
                if head.startswith("toml") and head != "toml fragment":
                    name = re.search(r'title="([^"]*)"', head)
                    path = folder / (name.group(1) if name else "case.toml")
                    path.write_text(text)
                    self.run_line(f"uplift check {path.name}", folder, where)
                    ran += 1
                elif head == "sh":
                    printed = "".join(self.run_line(command, folder, where) for command in text.splitlines() if command.startswith("uplift "))
                    ran += 1
                elif head == "output":
                    self.assertRegex(printed, re.compile(as_pattern(text), re.S), where)
        self.assertGreater(ran, 8)

    def run_line(self, command, folder, where):
        words = shlex.split(command, comments=True)
        done = subprocess.run([program(), *words[1:]], cwd=folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, f"{where}: {command}\n{done.stdout}{done.stderr}")
        return done.stdout


if __name__ == "__main__":
    main()
