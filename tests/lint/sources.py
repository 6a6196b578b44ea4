"""Sources: every `@source KEY` and every key of a scheme's table stands in docs/references.bib, once."""

import collections
import pathlib
import re
import sys

import tree

BIB_KEY = re.compile(r"^\s*@(?!comment|string|preamble)\w+\s*\{\s*([^,\s]+)\s*,", re.MULTILINE | re.IGNORECASE)
# After the first key more may follow, each shaped like one: AuthorAuthor2001.
AT_SOURCE = re.compile(r"@source[ \t]+([^\s,;]+)([^\n]*)")
KEY_SHAPE = re.compile(r"\b[A-Z][A-Za-z]+(?:19|20)\d\d[a-z]?\b")
LITERAL_KEY = re.compile(r'"([A-Z][A-Za-z]+(?:19|20)\d\d[a-z]?)"')
SOURCE_FIELD = re.compile(r'\.source\s*=\s*"([^"]*)"')


def named(text):
    """(index, key) of every source that this text names."""
    for match in AT_SOURCE.finditer(text):
        yield match.start(), match.group(1).rstrip(".:)")
        for further in KEY_SHAPE.finditer(match.group(2)):
            yield match.start(), further.group()
    for pattern in (LITERAL_KEY, SOURCE_FIELD):
        for match in pattern.finditer(text):
            yield match.start(), match.group(1)


def problems(root):
    bibliography = pathlib.Path(root) / "docs/references.bib"
    if not bibliography.exists():
        return []
    keys = collections.Counter(BIB_KEY.findall(bibliography.read_text(encoding="utf-8")))
    found = [f"docs/references.bib: '{key}' stands there {count} times" for key, count in keys.items() if count > 1]
    for path in tree.cpp_files(root):
        text = tree.read(root, path)
        for index, key in sorted(set(named(text))):
            if key not in keys:
                found.append(f"{path}:{tree.line_of(text, index)}: '{key}' is not in docs/references.bib")
    return found


if __name__ == "__main__":
    tree.report(problems(sys.argv[1]))
