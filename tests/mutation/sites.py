"""Where faults can be seeded in C++ sources, and how each is written so that a run-time switch turns it on.

A site is one place in one file with one operator. Every site keeps the lines of the file, so that
what a compiler says about the instrumented file holds for the original.
"""
import re
from dataclasses import dataclass

SWITCH = "::whirl_mutation::"
TOKEN = re.compile(
    r'(?P<comment>//(?:[^\n\\]|\\.|\\\n)*|/\*.*?\*/)'
    r'|(?P<raw>(?:u8|[uUL])?R"(?P<delim>[^\s()\\]{0,16})\(.*?\)(?P=delim)")'
    r'|(?P<text>(?:u8|[uUL])?"(?:[^"\\\n]|\\.)*")'
    r"|(?P<char>'(?:[^'\\\n]|\\.)+')"
    r'|(?P<directive>(?m:^)[ \t]*#(?:[^\n\\]|\\.|\\\n)*)'
    r"|(?P<number>\.?\d(?:[eEpP][+-]|'?[\w.])*)"
    r'|(?P<word>[A-Za-z_]\w*)'
    r'|(?P<op>::|->\*?|\+\+|--|<<=|>>=|<=>|<<|>>|<=|>=|==|!=|&&|\|\||\+=|-=|\*=|/=|%=|&=|\|=|\^=|\.\.\.|[^\s\w])',
    re.S)
OPENING = {"(": ")", "[": "]", "{": "}"}
ASSIGN = {"=", "+=", "-=", "*=", "/="}
# Calls that only spend or save time and memory, or tell the user how far a run is.
PERFORMANCE = {"reserve", "shrink_to_fit", "progress", "prefetch", "noalias", "flush", "checkpoint"}
COMPARE = {"<": "lt", "<=": "le", ">": "gt", ">=": "ge", "==": "eq", "!=": "ne"}
OPERATORS = {
    "sign": "a + b becomes a - b and back", "scale": "a number becomes 1.5 times itself",
    "more": "a whole number becomes one more", "if": "a condition is turned round",
    "choice": "the condition of ?: is turned round",
    "compare": "< becomes <= (whole numbers) or its opposite; == becomes !=",
    "logic": "the second condition of && or || no longer counts", "delete": "a statement is left out",
    "index": "[0] and [1], .x() and .y() and .z() are exchanged", "minmax": "min and max are exchanged",
    "return": "the sign (or truth) of what is returned", "exchange": "two neighbours of a list {a, b} are exchanged",
    "key": "another name of a result"}


@dataclass(frozen=True)
class Site:
    file: str
    line: int
    operator: str
    text: str     # the line
    nth: int      # among the sites of this operator with this text in this file
    edits: tuple  # (offset, length, replacement with @ for the site's number)

    @property
    def name(self):
        return f"{self.file} | {self.operator} | {self.text}" + (f" | #{self.nth}" if self.nth > 1 else "")


@dataclass
class Token:
    kind: str
    text: str
    at: int
    line: int
    match: int = -1  # of a bracket
    block: int = -1  # innermost enclosing {: index of its token

    @property
    def end(self):
        return self.at + len(self.text)


def tokens_of(source):
    out, line, last = [], 1, 0
    for m in TOKEN.finditer(source):
        line += source.count("\n", last, m.start())
        last = m.start()
        if m.lastgroup == "comment":
            continue
        kind = "raw" if m.group("raw") else m.lastgroup
        if kind in ("comment", "directive"):
            continue
        out.append(Token("text" if kind == "raw" else kind, m.group(), m.start(), line))
    stack = []
    for i, t in enumerate(out):
        if t.kind == "op" and t.text in ")]}":
            if stack:
                j = stack.pop()
                t.match, out[j].match = j, i
        braces = [j for j in stack if out[j].text == "{"]
        t.block = braces[-1] if braces else -1
        if t.kind == "op" and t.text in OPENING:
            stack.append(i)
    return out


class File:
    """The sites of one file."""

    def __init__(self, path, source):
        self.path, self.source = path, source
        self.lines = source.split("\n")
        self.t = tokens_of(source)
        self.kind = {}   # of each { token: code, class, list
        self.quiet = {}  # of each { token: inside something evaluated at compile time
        for i, t in enumerate(self.t):
            if t.text == "{" and t.kind == "op":
                self.classify(i)
        self.found = []

    def statement_start(self, i):
        """First token of the statement (or declaration) that token i belongs to."""
        j = i - 1
        while j >= 0:
            t = self.t[j]
            if t.kind == "op":
                if t.text == "}" and self.kind.get(t.match) in ("list", None):
                    j = t.match
                    if j < 0:
                        return 0
                elif t.text in ")]" and t.match >= 0:
                    j = t.match
                elif t.text in ";}":
                    return j + 1
                elif t.text == "{":
                    if self.kind.get(j) != "list":
                        return j + 1
            j -= 1
        return 0

    def classify(self, i):
        before = self.t[i - 1] if i else None
        parent = self.t[i].block
        start = self.statement_start(i)
        head = [t.text for t in self.t[start:i]]
        if "namespace" in head[:2]:
            kind = "class"
        elif "enum" in head[:2] and before.text != ")":
            kind = "list"
        elif {"class", "struct", "union"} & set(head) and before.text != ")" and "=" not in head and "(" not in head:
            kind = "class"
        elif before is None or before.text in (")", "const", "noexcept", "override", "mutable", "else", "do", "try", ";"):
            kind = "code"
        elif before.text in "{}" and self.kind.get(parent if before.text == "}" else i - 1) == "code" and (
                before.text == "{" or self.kind.get(before.match) == "code"):
            kind = "code"
        elif "->" in head and self.after_parameters(i):
            kind = "code"
        elif head and head[0] == "extern" and before.kind == "text":
            kind = "class"
        else:
            kind = "list"
        self.kind[i] = kind
        quiet = self.quiet.get(parent, False) and kind != "class"
        text = " ".join(head)
        if re.search(r"\b(constexpr|consteval|constinit)\b", text.replace("if constexpr", "if")):
            quiet = True
        if kind == "list" and re.search(r"\bstatic\b", text):
            quiet = True
        self.quiet[i] = quiet

    def after_parameters(self, i):
        """A lambda's or function's trailing return type stands before i."""
        j = i - 1
        while j >= 0 and (self.t[j].kind == "word" or self.t[j].text in ("::", "<", ">", "&", "*", ",")):
            j -= 1
        return j > 0 and self.t[j].text == "->" and self.t[j - 1].text in (")", "mutable", "const")

    def in_code(self, i):
        b = self.t[i].block
        while b >= 0 and self.kind[b] == "list":
            if self.quiet[b]:
                return False
            b = self.t[b].block
        return b >= 0 and self.kind[b] == "code" and not self.quiet[b]

    def usable(self, i):
        """Not in what is evaluated at compile time, thrown, or said to the user."""
        if not self.in_code(i):
            return False
        start = self.statement_start(i)
        first = self.t[start].text
        if first in ("throw", "static", "constexpr", "using", "typedef", "case", "static_assert", "template", "thread_local",
                     "WHIRL_EXPECTS", "assert", "goto"):
            return False
        depth = 0
        for j in range(i - 1, max(start - 1, -1), -1):  # enclosing calls
            t = self.t[j]
            if t.kind == "op":
                if t.text in ")]}":
                    depth += 1
                elif t.text in "([{":
                    if depth == 0 and j and self.t[j - 1].text in ("error", "warning", "run_error", "deck_error", "Error", "note",
                                                                     "alignas", "sizeof", "decltype", "WHIRL_EXPECTS", "constexpr",
                                                                     "noexcept", "requires"):
                        return False
                    depth -= depth > 0
            elif t.text in ("throw", "constexpr") and depth == 0:
                return False
        return True

    def add(self, i, operator, *edits):
        t = self.t[i]
        if not self.usable(i):
            return
        text = " ".join(self.lines[t.line - 1].split("//")[0].split()).replace("|", "¦")
        nth = 1 + sum(s.operator == operator and s.text == text for s in self.found)
        self.found.append(Site(self.path, t.line, operator, text, nth, tuple(edits)))

    def spaced(self, i):
        """Blanks on both sides in the formatted source: a comparison, not a bracket of a template."""
        t = self.t[i]
        return self.source[t.at - 1].isspace() and self.source[t.end].isspace()

    def parts(self, i):
        """First and last token of each element between the bracket i and its match."""
        out, first, j = [], i + 1, i + 1
        while j < self.t[i].match:
            t = self.t[j]
            if t.kind == "op" and t.text in OPENING:
                j = t.match
            elif t.text == ",":
                out.append((first, j - 1))
                first = j + 1
            j += 1
        if first < self.t[i].match:
            out.append((first, self.t[i].match - 1))
        return out

    def span(self, first, last):
        return self.source[self.t[first].at:self.t[last].end]

    def scan(self):
        for i in range(1, len(self.t) - 1):
            t = self.t[i]
            if t.kind == "number":
                self.number(i)
            elif t.kind == "op":
                self.operator(i)
            elif t.kind == "word":
                self.word(i)
            elif t.kind == "text" and self.t[i - 1].text == "[" and self.t[i + 1].text == "]":
                self.add(i, "key", (t.at, len(t.text), f"{SWITCH}text(@, {t.text})"))
        return self.found

    def number(self, i):
        t, before, after = self.t[i], self.t[i - 1].text, self.t[i + 1].text
        if before == "[" and after == "]":
            if t.text in ("0", "1") and self.t[i - 2].text != "operator" and (self.t[i - 2].kind == "word" or self.t[i - 2].text in ")]"):
                if self.t[i + 2].text not in (",", "{") and not self.declared(i - 2):
                    self.add(i, "index", (t.at, len(t.text), f"{SWITCH}index(@, {t.text})"))
            return
        if before == "(" and after == ")" and self.t[i - 2].text in ("col", "row") and t.text in "012":
            self.add(i, "index", (t.at, len(t.text), f"{SWITCH}index(@, {t.text})"))
            return
        if re.fullmatch(r"\d[\d']*\.?\d*(?:[eE][+-]?\d+)?|\.\d+", t.text) is None:
            return
        value = float(t.text.replace("'", ""))
        if re.fullmatch(r"[\d']+", t.text):
            if value <= 64 and (before in ("*", "/", "-", "+", "%") or after in ("*", "/", "-", "+", "%")) and self.t[i - 2].text != "<":
                if self.t[i - 1].kind == "op":
                    self.add(i, "more", (t.at, len(t.text), f"({t.text} + {SWITCH}more(@))"))
        elif 1e-3 <= value <= 1e8:  # smaller: thresholds against rounding, larger: instead of infinity
            self.add(i, "scale", (t.at, len(t.text), f"({t.text} * {SWITCH}scale(@))"))

    def declared(self, i):
        """Token i is the name of an array being declared (or a later one of a list)."""
        return self.t[i].kind == "word" and self.t[i - 1].kind == "word" and self.t[i - 1].text not in ("return", "else", "and", "or")

    def operator(self, i):
        t, before, after = self.t[i], self.t[i - 1], self.t[i + 1]
        if before.text == "operator":
            return
        operand = before.kind in ("word", "number") or before.text in (")", "]")
        if before.kind == "word" and before.text in ("return", "case", "else", "co_return", "throw"):
            operand = False
        if t.text in "+-" and operand and self.spaced(i) and after.kind != "text":
            self.add(i, "sign", (t.end, 0, f" {SWITCH}sign(@) *"))
        elif t.text in COMPARE and operand and self.spaced(i) and before.text != "template":
            self.add(i, "compare", (t.end, 0, f" {SWITCH}compare<{SWITCH}Op::{COMPARE[t.text]}>(@) {t.text}"))
        elif t.text in ("&&", "||") and self.spaced(i):
            name = "also(@) |" if t.text == "&&" else "unless(@) &"
            self.add(i, "logic", (t.end, 0, f" {SWITCH}{name}"))
        elif t.text == "?":
            self.add(i, "choice", (t.at, 0, f"& {SWITCH}flipped(@) "))
        elif t.text == "{" and self.kind[i] == "list":
            parts = self.parts(i)
            for a, b in zip(parts, parts[1:]):
                x, y = self.span(*a), self.span(*b)
                if x == y or "\n" in x + y or "//" in x + y or "[" in (x[0], y[0]) or "{" in (x[0], y[0]) or x[0] == "." or '"' in x + y:
                    continue
                if re.fullmatch(r"[\d.]+", x) and re.fullmatch(r"[\d.]+", y):
                    continue  # bounds, sizes: what narrows must stay a constant
                self.add(a[0], "exchange", (self.t[a[0]].at, len(x), f"{SWITCH}pick(@, {x}, {y})"),
                         (self.t[b[0]].at, len(y), f"{SWITCH}pick(@, {y}, {x})"))
        if t.text in ";{}" or (t.text == ")" and self.t[t.match - 1].text in ("if", "for", "while")):
            self.statement(i + 1)

    def word(self, i):
        t, after = self.t[i], self.t[i + 1]
        if t.text == "if" and after.text == "(":
            inside = self.t[i + 2:after.match]
            if inside and not any(x.text in (";", "=") for x in inside):
                a, b = inside[0].at, inside[-1].end
                self.add(i, "if", (a, 0, "static_cast<bool>("), (b, 0, f") != {SWITCH}on(@)"))
        elif t.text in ("else", "do"):
            self.statement(i + 1)
        elif t.text in ("min", "max") and after.text == "(" and self.span(i - 2, i - 1) == "std::":
            name = "smaller" if t.text == "min" else "larger"
            self.add(i, "minmax", (self.t[i - 2].at, t.end - self.t[i - 2].at, f"{SWITCH}{name}{{@}}"))
        elif t.text in ("x", "y", "z") and self.t[i - 1].text == "." and after.text == "(" and self.t[i + 2].text == ")":
            self.add(i, "index", (self.t[i - 1].at, self.t[i + 2].end - self.t[i - 1].at,
                                  f"[{SWITCH}component(@, {'xyz'.index(t.text)})]"))
        elif t.text == "return":
            self.returned(i)

    def returned(self, i):
        end, j, telling = None, i + 1, False
        while j < len(self.t):
            x = self.t[j]
            if x.kind == "op" and x.text in OPENING:
                if x.text in "{" or (x.text == "[" and j == i + 1):
                    return
                j = x.match
            elif x.text == ";":
                end = j
                break
            elif x.kind == "text" or x.text == "?":
                return
            elif x.text in ("+", "-", "*", "/", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "!", "true", "false", "norm", "dot"):
                telling = True
            j += 1
        if end is None or end == i + 1 or not telling:
            return
        a, b = self.t[i + 1].at, self.t[end - 1].end
        self.add(i, "return", (a, 0, f"{SWITCH}sign(@) * ("), (b, 0, ")"))

    def statement(self, i):
        """Leaves out an assignment or a call whose value nobody takes."""
        if i + 2 >= len(self.t) or self.t[i].kind not in ("word", "op"):
            return
        first = self.t[i]
        if first.text in ("return", "if", "for", "while", "switch", "else", "do", "case", "default", "using", "throw", "static", "const",
                          "auto", "break", "continue", "delete", "goto", "typedef", "template", "public", "private", "static_cast",
                          "struct", "class", "WHIRL_EXPECTS", "assert", "co_return", "operator"):
            return
        j = i + (first.text == "*")
        if self.t[j].text in ("++", "--"):
            return
        if self.t[j].kind != "word":
            return
        j += 1
        last_word, called = self.t[j - 1].text, False
        while True:
            x = self.t[j]
            if x.kind == "op" and x.text in ("::", ".", "->") and self.t[j + 1].kind == "word":
                j += 2
                last_word, called = self.t[j - 1].text, False
            elif x.kind == "op" and x.text in "([" and x.match > 0:
                called = x.text == "("
                j = x.match + 1
            else:
                break
        if last_word in PERFORMANCE:
            return
        if self.t[j].text in ASSIGN:
            while self.t[j].text != ";":
                if self.t[j].kind == "op" and self.t[j].text in OPENING:
                    j = self.t[j].match
                j += 1
                if j >= len(self.t) or self.t[j].text in ")}":
                    return
        elif not (called and self.t[j].text == ";"):
            return
        a, b = first.at, self.t[j].end
        self.add(i, "delete", (a, 0, f"{{ if (!{SWITCH}on(@)) "), (b, 0, " }"))


def sites_of(path, source):
    return File(path, source).scan()


def given_site(source, fault):
    """A fault written by hand: {was, file, edit: [[before, after, nth], ...]}."""
    edits = []
    for before, after, *nth in fault["edit"]:
        at = -1
        for _ in range(nth[0] if nth else 1):
            at = source.find(before, at + 1)
            if at < 0:
                raise ValueError(f"{fault['file']} has no '{before}' any more: {fault['was']}")
        if before.endswith(";"):
            text = f"{{ if ({SWITCH}on(@)) {{ {after} }} else {{ {before} }} }}"
        else:
            text = f"({SWITCH}on(@) ? ({after}) : ({before}))"
        edits.append((at, len(before), text))
    line = 1 + source.count("\n", 0, edits[0][0])
    return Site(fault["file"], line, "given", fault["was"], 1, tuple(edits))


def instrumented(source, sites, switch):
    """The source with the given sites, {number: site}, written into it."""
    edits = []
    for number, site in sites.items():
        for order, (at, length, text) in enumerate(site.edits):
            edits.append((at, length, order, text.replace("@", str(number))))
    # Nested edits of one place: none replaces what another one edits.
    edits.sort(key=lambda e: (e[0], e[1]))
    out, last = [], 0
    for at, length, _, text in edits:
        if at < last:
            raise ValueError("sites overlap")
        out += [source[last:at], text]
        last = at + length
    out.append(source[last:])
    text = "".join(out)
    return f'#include "{switch}"\n#line 1\n' + text if switch else text


def clash(a, b):
    """One site's edit touches text that the other one replaces, or both insert at one place."""
    for at, length, _ in a.edits:
        for other_at, other_length, _ in b.edits:
            if length == 0 and other_length == 0:
                if at == other_at:
                    return True
            elif at <= other_at + other_length and other_at <= at + length:
                return True
    if len(a.edits) == 2 and len(b.edits) == 2:  # brackets may nest or lie apart, not cross
        (a0, a1), (b0, b1) = ([e[0] for e in x.edits] for x in (a, b))
        return a0 < b0 < a1 < b1 or b0 < a0 < b1 < a1
    return False
