"""Plain words: first lines that name something, short sentences, and no forbidden word in prose.

Prose is docstrings, comments, pages, help and messages. Code, names and quotations in backticks are not.
"""

import ast
import io
import re
import tokenize
from html.parser import HTMLParser
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("src", "docs", "examples", "benchmarks", "scripts", "tests")
SUFFIXES = {".py", ".md", ".html", ".js", ".css", ".sh", ".toml"}
# Expected answers and tasks: committed before the names and pages that they examine, and not edited since.
FIXED = {"reading_tasks.md", "reader_questions.md"}
FILES = sorted(
    [path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.suffix in SUFFIXES - {".toml"}]
    + [*ROOT.glob("*.md"), *ROOT.glob("*.py"), ROOT / "Makefile", ROOT / "pyproject.toml"]
)

# The forbidden word → what to write.
FORBIDDEN = {
    r"guests?": "work item",
    r"seat|seats|seated": "assign to a lane",
    r"desks?": "workspace",
    r"told|foretold": "reported, given, predicted",
    r"asked": "requested, given, specified",
    r"heeds?|heeded": "take into account",
    r"dear|dearer|dearest": "expensive",
    r"lest": "so that … not",
    r"anew": "again",
    r"so many": "the number",
    r"save that": "except that",
    r"for ever": "permanently",
    r"brought near": "prefetched",
    r"one another's": "of each other",
    r"unless given": "Default: …",
    r"unsymmetric": "asymmetric",
    r"a (?!few|little|lot)\w+ an? \w+": "one X per Y, each Y has an X",
}
WORDS = re.compile("|".join(rf"\b(?:{word})\b" for word in FORBIDDEN), re.IGNORECASE)
FIRST = re.compile(
    r"(?:What|How|Who|Whose|Whom|Where|When|Which|Why|Whether|The same|Those|Of|So|In|Like)\b|\("
)
MAX_WORDS = 25
# (file, the words as found) → why they stand.
EXCEPTIONS: dict[tuple[str, str], str] = {}


def named(path):
    return path.relative_to(ROOT).as_posix()


def without_code(text):
    """Return a text without inline code, doctests, entries of BibTeX and links' targets."""
    text = re.sub(r"^\s*(?:>>>|\.\.\. ).*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"^@\w+\{.*?^\}", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"``.+?``|`[^`]*`|\]\([^)]*\)|\$\$.*?\$\$", " … ", text, flags=re.DOTALL)


def docstrings(tree):
    """Yield the constants that document a module, a class or a function, or an attribute above them."""
    for node in ast.walk(tree):
        for statement in getattr(node, "body", []) if not isinstance(node, ast.Lambda | ast.IfExp) else []:
            value = statement.value if isinstance(statement, ast.Expr) else None
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                yield value


def python_prose(source, messages):
    """Yield line and text of each docstring and comment; with `messages` also of each string with a space."""
    tree = ast.parse(source)
    documents = list(docstrings(tree))
    yield from ((node.lineno, node.value) for node in documents)
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    if messages:
        for node in ast.walk(tree):
            text = node.value if isinstance(node, ast.Constant) else None
            if isinstance(text, str) and " " in text.strip() and node not in documents:
                yield node.lineno, text


class Page(HTMLParser):
    """Words of an HTML page: between tags, and in the attributes that are shown."""

    def __init__(self):
        super().__init__()
        self.found = []
        self.code = False

    def handle_starttag(self, tag, attrs):
        self.code = tag in ("script", "style")
        shown = [value for name, value in attrs if name in ("title", "alt", "placeholder", "aria-label")]
        self.found += [(self.getpos()[0], value) for value in shown if value]

    def handle_endtag(self, tag):
        self.code = False

    def handle_data(self, data):
        if not self.code:
            self.found.append((self.getpos()[0], data))
        else:
            self.found += [(self.getpos()[0] + line - 1, text) for line, text in script_prose(data)]


def script_prose(source):
    """Yield line and text of comments, and of strings with a space, in JavaScript or CSS."""
    for found in re.finditer(
        r"/\*.*?\*/|(?<!:)//.*|\"[^\"\n]* [^\"\n]*\"|'[^'\n]* [^'\n]*'|`[^`]* [^`]*`", source, re.DOTALL
    ):
        text = found.group() if not found.group().startswith("//") else found.group().partition("\n")[0]
        yield source.count("\n", 0, found.start()) + 1, re.sub(r"\$\{[^}]*\}", "…", text).strip("`")


def page_prose(source):
    """Yield line and text of a page of Markdown, with the docstrings and comments of its blocks of Python."""
    for fence in re.finditer(r"^```(.*?)\n(.*?)^```", source, re.MULTILINE | re.DOTALL):
        if fence[1].strip() == "python":
            start = source.count("\n", 0, fence.start()) + 1
            yield from ((start + line, text) for line, text in python_prose(fence[2], messages=False))
    blank = re.sub(
        r"^```.*?^```", lambda fence: "\n" * fence.group().count("\n"), source, flags=re.MULTILINE | re.DOTALL
    )
    line = 1
    for paragraph in re.split(r"(\n\s*\n)", blank):
        yield line, paragraph
        line += paragraph.count("\n")


def prose(path):
    """List line and text of each piece of prose in a file."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        return list(python_prose(source, messages="src" in path.relative_to(ROOT).parts))
    if path.suffix == ".md":
        return [] if path.name in FIXED else list(page_prose(source))
    if path.suffix == ".html":
        page = Page()
        page.feed(source)
        return page.found
    if path.suffix in (".js", ".css"):
        return list(script_prose(source))
    return [(number, line) for number, line in enumerate(source.split("\n"), 1) if "#" in line]


def forbidden(path):
    """Yield each forbidden word in the prose of a file, as `file:line: words`."""
    for line, text in prose(path):
        for found in WORDS.finditer(" ".join(without_code(text).split())):
            if (named(path), found.group()) not in EXCEPTIONS:
                yield f"{named(path)}:{line}: {found.group()}"


def long_sentences(path):
    """Yield each sentence of more than 25 words, as `file:line: its beginning`.

    An item of a list, a row of a table or a parameter ends a sentence.
    """
    breaks = r"\n\s*\n|\n\s*(?:[-*]|\d+\.) |\n\s*(?=[\w, ]+ : )|\n(?=#)|\|"
    for line, text in prose(path):
        for part in re.split(breaks, without_code(text)):
            for sentence in re.split(r"(?<=[.!?])\s+", " ".join(part.split())):
                if len(re.findall(r"[\w’'-]+", sentence)) > MAX_WORDS:
                    yield f"{named(path)}:{line}: {sentence[:80]}"


def riddles(path):
    """Yield each docstring whose first line begins with a word that names nothing, as `file:line: line`."""
    for node in docstrings(ast.parse(path.read_text(encoding="utf-8"))):
        first = node.value.strip().partition("\n")[0]
        if FIRST.match(first):
            yield f"{named(path)}:{node.lineno}: {first}"


@pytest.mark.parametrize("path", [path for path in FILES if path != Path(__file__)], ids=named)
def test_prose_has_no_forbidden_word(path):
    assert list(forbidden(path)) == []


@pytest.mark.parametrize(
    "path", [path for path in FILES if "tests" not in path.relative_to(ROOT).parts], ids=named
)
def test_sentences_are_short(path):
    assert list(long_sentences(path)) == []


@pytest.mark.parametrize("path", [path for path in FILES if path.suffix == ".py"], ids=named)
def test_first_line_of_a_docstring_says_what_it_is(path):
    assert list(riddles(path)) == []


def test_every_exception_stands_for_something():
    found = {
        (named(path), words.group())
        for path in FILES
        for _, text in prose(path)
        for words in WORDS.finditer(" ".join(without_code(text).split()))
    }
    assert set(EXCEPTIONS) <= found


def test_forbidden_words_are_found_in_prose_and_not_in_code():
    source = '''"""What it is."""
told = 1  # a row a point
print("the guests are seated", told, "asked")


def f():
    """Return a few a day, `asked` and told.

    >>> told = f()
    """
'''
    found = [
        words.group()
        for _, text in python_prose(source, messages=True)
        for words in WORDS.finditer(" ".join(without_code(text).split()))
    ]
    assert sorted(found) == ["a row a point", "guests", "seated", "told"]
    page = Page()
    page.feed('<p title="dear one">anew</p><script>const told = "so many words"; // lest\n</script>')
    assert [text for _, text in page.found] == ["dear one", "anew", '"so many words"', "// lest"]
    assert [text for _, text in page_prose("told\n\n```python\nx = 1  # asked\n```\n") if text.strip()] == [
        "# asked",
        "told",
    ]
