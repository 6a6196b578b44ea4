"""Messages in plain English: no literal of the program, and no text of the tests' table of bad scenes, has a phrase of PHRASES.

Each phrase stands with the better words for it. What is looked at is every string literal with a blank in it outside of tests
(adjacent ones as one, code in backticks left out), and `tests/scenes/bad/scenes.txt`; comments and the prose of docs are free.
"""

import re
import sys

import tree

# Nouns that a message must not deny with "is no": "a step of 0 is no step". "There is no step" is plain.
DENIED = r"(?<![Tt]here )\b(?:is|are|was|were) no (?!longer\b|more\b|less\b|such\b|fewer\b|better\b|worse\b|other\b|further\b)[a-z]"

# what must not be in a message: the better words
PHRASES = {
    DENIED: "is not a ..., is not a valid ..., there is no ...",
    r"\b(?:is|are) none of\b": "is not one of, is not valid in",
    r"\bnobody\b": "no particle, no force, nothing",
    r"\bsomebody\b": "another particle, a particle",
    r"\bwhom\b": "which particles",
    r"\bknows? (?:no|only|nothing|open)\b": "does not support, supports only",
    r"\bknown are\b": "expected one of",
    r"\bmeans? nothing to\b": "has no effect",
    r"\b(?:is|are) (?:not )?to be had\b": "is available, is supported",
    r"\bhas it\b": "is there",
    r"\bthere are none of\b": "there are no",
    r"\bno way back\b": "cannot go back in time",
    r"\bthe other way\b(?! round)": "in the opposite direction",
    r"\bno time ahead\b": "leaves no time, is not a valid interval",
    r"\b(?:stands?|stood|standing) (?:beside|behind|alone|both|there|here|twice|in one|already|still|before|after|around|inside|in)\b":
        "is given together with, comes after, appears twice, is in",
    r"\bstands? \S+ times\b": "appears ... times",
    r"\b(?:was|were|is|are) asked for\b": "is required, was requested",
    r"\basks? for (?:a |an |one |as |it\b|them\b|more|many|fewer)": "needs",
    r"\b(?:wants?|wanted|wishes)\b": "needs",
    r"\btells? (?:none|no|its|his|the motion|them)\b": "does not compute, has no",
    r"\bserves? (?:only|q|y|as)\b": "is for",
    r"\bgives? none\b": "does not give it, does not compute it",
    r"\bgoes by\b": "is named, follows",
    r"\b(?:it|they) (?:is|are) none\b": "it is not one",
    r"\btakes? no (?!value\b|argument)": "does not support, does not have",
    r"\btakes? part in no\b": "is not part of any",
    r"\bof its own choice\b": "chosen by the method",
    r"\bsays? (?:nothing of|nothing$|none|twice|when|more)\b": "does not say, has no, gives two",
    r"\bholds? (?:what|no|nothing)\b": "contains, is empty",
    r"\b(?:evaluations?|kicks?|errors|accurate|solutions?|numbers?|moves?|sums?) a (?:step|kick|particle|stage|moment|line)\b":
        "per step, per kick, per particle",
    r"\bone a (?:line|step)\b": "one per line",
    r"\bdear (?:forces?|evaluations?)\b": "expensive",
    r"\b(?:is|are|was) (?:not )?read\b(?! as| in | from| by)": "is supported, is ignored",
    r"\bbehind\b": "after",
    r"\b(?:mends?|mended)\b": "repairs",
    r"\bgo(?:es)? on (?:with|by|without)\b": "continue with, resume",
    r"\bstart afresh\b": "start over",
    r"\bare announced\b": "are declared",
    r"\b(?:two|of) looks\b|\blooks? (?:further|nearer|more often)\b": "samples, checks",
    r"\b(?:does|do) not come to\b": "reach",
    r"\b(?:does|do|did|will) not go with\b": "does not work with",
    r"\bgo(?:es)? to rounding\b": "solves to rounding",
    r"\bdrives instead\b": "would drive the motion instead",
    r"\bchanges? by (?:itself|themselves)\b": "changes",
    r"\bmove about\b": "orbit",
    r"\bwould be written over\b": "would overwrite",
    r"\b(?:keeps?|kept|has|have|with|in) (?:a |an )?(?!file|folder)\w+ of (?:its|their) own\b": "its own ...",
}
FORBIDDEN = [(re.compile(phrase), better) for phrase, better in PHRASES.items()]
LITERAL = re.compile(r'(?<![\w\'\\])"((?:\\.|[^"\\\n])*)"')
CODE = re.compile(r"`[^`]*`")
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


def problems(root):
    found = []
    for path in tree.cpp_files(root):
        if path.parts[0] == "tests":
            continue
        text = tree.blank(tree.read(root, path))
        for index, message in messages(text):
            if " " not in message.strip():
                continue
            found += [f"{path}:{tree.line_of(text, index)}: \"{phrase}\" in a message; better: {better}"
                      for phrase, better in found_in(message)]
    return found + table_problems(root)


def table_problems(root):
    """The same of the messages that scenes are refused with."""
    path = tree.pathlib.Path(root) / TABLE
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [f"{TABLE}:{number}: \"{phrase}\" in a message; better: {better}"
            for number, line in enumerate(lines, 1) if "#!" in line
            for phrase, better in found_in(line[line.index("#!"):])]


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
