"""Values in brackets, as calls of subprograms and cycles give them."""

from twin.nc.control.control import Control


def split_values(text: str) -> list[tuple[str, int]]:
    """The texts between the commas outside brackets and quotes, with their places."""
    found, depth, begin, quoted = list[tuple[str, int]](), 0, 0, False
    for at, character in enumerate(text):
        if character == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
        elif character == "," and depth == 0:
            found.append((text[begin:at], begin))
            begin = at + 1
    return [*found, (text[begin:], begin)]


def bracketed(control: Control, text: str, column: int) -> tuple[str, int, int]:
    """The text within the brackets that begin a text, its column, and the place behind them."""
    at = len(text) - len(text.lstrip())
    if text[at : at + 1] != "(":
        return "", column + at, at
    depth, quoted, end = 0, False, at
    while depth > 0 or end == at:
        if end == len(text):
            hint = "write ) where its bracket ends"
            at = column + len(text.rstrip())
            control.report.fail("expression", "')' is missing here", at, hint=hint)
        character = text[end]
        quoted ^= character == '"'
        depth += 0 if quoted else (character == "(") - (character == ")")
        end += 1
    return text[at + 1 : end - 1], column + at + 1, end
