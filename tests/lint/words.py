"""Texts in plain English: what users read has no phrase of PHRASES. Each phrase comes with the better words for it.

These texts are looked at; comments are free:
- of C++ outside of tests every string literal with a blank in it, adjacent ones as one, code in backticks left out;
- `tests/scenes/bad/scenes.txt`, the messages that scenes are refused with;
- the launcher, the page of `noether view` with its scripts, and the files of CMake;
- string literals of Python outside of tests, and the documents of scripts that print them;
- the prose of README.md, CONTRIBUTING.md, ARCHITECTURE.md, docs/ and examples' READMEs, by the phrases that are never plain.
"""

import ast
import re
import sys

import tree

# Nouns that a message must not deny with "is no": "a step of 0 is no step". "There is no step" is plain.
DENIED = r"(?<![Tt]here )\b(?:is|are|was|were) no (?!longer\b|more\b|less\b|such\b|fewer\b|better\b|worse\b|other\b|further\b)[a-z]"

# What must be neither in a message nor in the prose of a page: the better words.
PHRASES = {
    DENIED: "is not a ..., is not a valid ..., there is no ...",
    r"\b(?:is|are) none of\b": "is not one of, is not valid in",
    r"\bnobody\b": "no particle, no force, nothing",
    r"\bsomebody\b": "another particle, a particle",
    r"\bwhom\b": "which particles",
    r"\bknows? (?:no|only|nothing|open)\b": "does not support, supports only",
    r"\bknown are\b": "expected one of",
    r"\bmeans? nothing to\b": "has no effect",
    r"\bof its own choice\b": "chosen by the method",
    r"\b(?:is|are) (?:not )?to be had\b": "is available, is supported",
    r"\bthere are none of\b": "there are no",
    r"\bno way back\b": "cannot go back in time",
    r"\bno time ahead\b": "leaves no time, is not a valid interval",
    r"\bgives? none\b": "does not give it, does not compute it",
    r"\b(?:it|they) (?:is|are) none\b": "it is not one",
    r"\bholds? (?:what|no|nothing)\b": "contains, is empty",
    r"\b(?:evaluations?|kicks?|errors|accurate|solutions?|numbers?|moves?|sums?) a (?:step|kick|particle|stage|moment|line)\b":
        "per step, per kick, per particle",
    r"\bone a (?:line|step)\b": "one per line",
    r"\bdear (?:forces?|evaluations?)\b": "expensive",
    r"\bgo(?:es)? on (?:with|by|without)\b": "continue with, resume",
    r"\bstart afresh\b": "start over",
    r"\bare announced\b": "are declared",
    r"\b(?:does|do) not come to\b": "reach",
    r"\b(?:does|do|did|will) not go with\b": "does not work with",
    r"\bgo(?:es)? to rounding\b": "solves to rounding",
    r"\bdrives instead\b": "would drive the motion instead",
    r"\bchanges? by (?:itself|themselves)\b": "changes",
    r"\bwould be written over\b": "would overwrite",
}
# What must not be in a message, though it has plain meanings that prose may need.
IN_MESSAGES = {
    r"\bhas it\b": "is there",
    r"\bthe other way\b(?! round)": "in the opposite direction",
    r"\b(?:stands?|stood|standing) (?:beside|behind|alone|both|there|here|twice|in one|already|still|before|after|around|inside|in)\b":
        "is given together with, comes after, appears twice, is in",
    r"\bstands? \S+ times\b": "appears ... times",
    r"\b(?:was|were|is|are) asked for\b": "is required, was requested",
    r"\basks? for (?:a |an |one |as |it\b|them\b|more|many|fewer)": "needs",
    r"\b(?:wants?|wanted|wishes)\b": "needs",
    r"\btells? (?:none|no|its|his|the motion|them)\b": "does not compute, has no",
    r"\bserves? (?:only|q|y|as)\b": "is for",
    r"\bgoes by\b": "is named, follows",
    r"\btakes? no (?!value\b|argument)": "does not support, does not have",
    r"\btakes? part in no\b": "is not part of any",
    r"\bsays? (?:nothing of|nothing$|none|twice|when|more)\b": "does not say, has no, gives two",
    r"\b(?:is|are|was) (?:not )?read\b(?! as| in | from| by)": "is supported, is ignored",
    r"\bbehind\b": "after",
    r"\b(?:mends?|mended)\b": "repairs",
    r"\b(?:two|of) looks\b|\blooks? (?:further|nearer|more often)\b": "samples, checks",
    r"\bmove about\b": "orbit",
    r"\b(?:keeps?|kept|has|have|with|in) (?:a |an )?(?!file|folder)\w+ of (?:its|their) own\b": "its own ...",
}
PROSE = [(re.compile(phrase.replace(" ", r"\s")), better) for phrase, better in PHRASES.items()]
FORBIDDEN = [(re.compile(phrase), better) for phrase, better in (PHRASES | IN_MESSAGES).items()]
LITERAL = re.compile(r'(?<![\w\'\\])"((?:\\.|[^"\\\n])*)"')
CODE = re.compile(r"`[^`]*`")
RAW = re.compile(r'R"(?P<mark>[^(\s"]*)\((?P<text>.*?)\)(?P=mark)"', re.DOTALL)
SCRIPT_COMMENT = re.compile(r'("(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|`(?:\\.|[^`\\])*`)|//[^\n]*|/\*.*?\*/', re.DOTALL)
SCRIPT_LITERAL = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|`(?:\\.|[^`\\])*`')
FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
PAGES = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "docs/[!n]*.md", "docs/notation.md", "docs/theory/*.md", "examples/*/README.md"]
TABLE = "tests/scenes/bad/scenes.txt"


def messages(text):
    """(index, text) of every group of adjacent string literals in C++ text without comments."""
    group = None
    for literal in LITERAL.finditer(text):
        if group and not text[group[1]:literal.start()].strip():
            group = (group[0], literal.end(), group[2] + literal.group(1))
            continue
        if group:
            yield group[0], group[2]
        group = (literal.start(), literal.end(), literal.group(1))
    if group:
        yield group[0], group[2]


def found_in(message):
    return [(match.group(), better) for phrase, better in FORBIDDEN
            for match in [phrase.search(CODE.sub("``", message))] if match]


def cpp_texts(text):
    """Literals of C++, raw ones too."""
    text = tree.blank(text)
    yield from messages(RAW.sub(lambda raw: re.sub(r"[^\n]", " ", raw.group()), text))
    for raw in RAW.finditer(text):
        yield from lines(raw.group("text"), raw.start("text"))


def script_texts(text):
    """Literals of JavaScript."""
    for literal in SCRIPT_LITERAL.finditer(SCRIPT_COMMENT.sub(lambda found: found.group(1) or " " * len(found.group()), text)):
        yield literal.start(), literal.group()[1:-1]


def shell_texts(text):
    """Lines of a shell script or of CMake, without their comments."""
    for index, line in lines(text):
        yield index, re.sub(r"(^|\s)#.*", "", line)


def python_texts(text):
    """Literals of Python; documents only of scripts that print theirs."""
    module = ast.parse(text)
    documents = {id(node.body[0].value) for node in ast.walk(module) if "__doc__" not in text
                 and isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef)) and ast.get_docstring(node) is not None}
    starts = [0] + [found.end() for found in re.finditer(r"\n", text)]
    for node in ast.walk(module):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents:
            yield starts[node.lineno - 1], node.value


def lines(text, start=0):
    for line in text.splitlines(keepends=True):
        yield start, line
        start += len(line)


# files below the root: how to find the texts in them
PLACES = [
    (["noether"], shell_texts),
    (["CMakeLists.txt", "cmake/*.cmake", "cmake/*.in", "*/CMakeLists.txt", "examples/*/CMakeLists.txt"], shell_texts),
    (["cli/view/*.js"], script_texts),
    (["cli/view/*.html"], lines),
    (["cmake/*.py", "bench/**/*.py", "examples/*/*.py"], python_texts),
]


def problems(root):
    root = tree.pathlib.Path(root)
    files = [(path, cpp_texts) for path in tree.cpp_files(root) if path.parts[0] != "tests"]
    for patterns, texts in PLACES:
        files += [(path.relative_to(root), texts) for pattern in patterns for path in sorted(root.glob(pattern)) if path.is_file()]
    found = []
    for path, texts in files:
        text = tree.read(root, path)
        for index, message in texts(text):
            if " " not in message.strip():
                continue
            found += [f"{path}:{tree.line_of(text, index)}: \"{phrase}\" in a message; better: {better}"
                      for phrase, better in found_in(message)]
    return found + table_problems(root) + prose_problems(root)


def table_problems(root):
    """The same of the messages that scenes are refused with."""
    path = tree.pathlib.Path(root) / TABLE
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [f"{TABLE}:{number}: \"{phrase}\" in a message; better: {better}"
            for number, line in enumerate(lines, 1) if "#!" in line
            for phrase, better in found_in(line[line.index("#!"):])]


def prose_problems(root):
    """The same of the pages, outside of code; paragraphs as one, because phrases are broken at the ends of lines."""
    found = []
    for path in [path for pattern in PAGES for path in sorted(tree.pathlib.Path(root).glob(pattern))]:
        text = FENCED.sub(lambda block: re.sub(r"[^\n]", " ", block.group()), path.read_text(encoding="utf-8"))
        text = CODE.sub(lambda code: "`" + re.sub(r"[^\n]", " ", code.group()[1:-1]) + "`", text)
        for phrase, better in PROSE:
            found += [f"{path.relative_to(root)}:{tree.line_of(text, match.start())}: \"{' '.join(match.group().split())}\"; "
                      f"better: {better}" for match in phrase.finditer(text)]
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
