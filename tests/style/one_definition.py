#!/usr/bin/env python3
"""Fails where two files define the same type, function or inline variable.

The linker keeps one of two inline functions of the same name and drops the other without a word:
two classes `symcell::Cavity` with different members once ended in a crash of debug builds only.
So every qualified name with external linkage is defined in one file of core, api, server, tests.

    one_definition.py ROOT        scans the tree; exit code 1 and a line a name if any occurs twice
    one_definition.py --self-test

Read are the sources, not the objects: a type need not leave a symbol there. Looked at are
definitions in namespaces, and types in classes, but nothing in unnamed namespaces or function
bodies, nothing static; functions are distinguished by their parameters' types as written. Names that
each program has its own of (`main`) are left out.
"""

import pathlib
import re
import sys

FOLDERS = ("core", "api", "server", "tests")
ONE_A_PROGRAM = {"main", "LLVMFuzzerTestOneInput", "LLVMFuzzerInitialize"}

TOKEN = re.compile(
    r"""
    (?P<skip>\s+|//[^\n]*|/\*.*?\*/|\#(?:[^\n\\]|\\.)*)  # comments, the preprocessor
  | R"(?P<delimiter>[^()\\\s]*)\(.*?\)(?P=delimiter)"
  | (?P<text>(?:u8|[uUL])?"(?:[^"\\\n]|\\.)*")
  | (?P<char>(?:u8|[uUL])?'(?:[^'\\\n]|\\.)+')
  | (?P<number>\.?\d(?:[\w.]|'\w|[eEpP][+-])*)
  | (?P<word>[A-Za-z_]\w*)
  | (?P<mark>::|->|&&|\[\[|.)
    """,
    re.VERBOSE | re.DOTALL,
)
OPENING = {"(", "{", "[", "[["}  # what an attribute opens, two ] close
TYPE_KEYS = {"struct", "class", "union", "enum"}
BUILT_IN = set("void bool char short int long float double unsigned signed auto".split())
QUALIFIERS = {"const", "volatile", "struct", "class", "enum", "typename"}


def tokens_of(text):
    """Words, marks, and '""' for literals."""
    tokens = []
    for match in TOKEN.finditer(text):
        kind = match.lastgroup
        if kind == "skip":
            continue
        if kind in ("text", "char", "delimiter"):
            tokens.append('""')
        else:
            tokens.append(match[0])
    return tokens


def matching(tokens, i):
    """The index behind the bracket that closes the one at i."""
    depth = 0
    while i < len(tokens):
        if tokens[i] in OPENING:
            depth += len(tokens[i])
        elif tokens[i] in (")", "}", "]"):
            depth -= 1
        i += 1
        if depth == 0:
            return i
    return i


def behind_template(head, i):
    """The index behind the <...> at i."""
    depth = 0
    while i < len(head):
        if head[i] in ("(", "{", "["):
            i = matching(head, i)
            continue
        depth += {"<": 1, ">": -1}.get(head[i], 0)
        i += 1
        if depth == 0:
            return i
    return i


def without_prefix(head):
    """A declaration without template heads, attributes and alignas."""
    result, i = [], 0
    while i < len(head):
        if head[i] == "template":
            i = behind_template(head, i + 1) if head[i + 1 : i + 2] == ["<"] else i + 1
        elif head[i] == "[[":
            i = matching(head, i)
        elif head[i] == "alignas":
            i = matching(head, i + 1)
        else:
            result.append(head[i])
            i += 1
    return result


def top_level(head, wanted):
    """The index of the first token in `wanted` outside of brackets and template arguments, or -1."""
    i = 0
    while i < len(head):
        if head[i] in wanted:
            return i
        if head[i] == "operator":  # operator() and operator= are names
            i += 2
            while i < len(head) and head[i] != "(":
                i += 1
            if "(" in wanted and head[i : i + 1] == ["("]:
                second = head[i : i + 3] == ["(", ")", "("]
                return i + 2 if second else i
            continue
        if head[i] in OPENING:
            i = matching(head, i)
        elif head[i] == "<" and i > 0 and re.match(r"\w", head[i - 1]):
            i = behind_template(head, i)
        else:
            i += 1
    return -1


def name_before(head, end):
    """The qualified name that ends at `end`, spelt without blanks."""
    start = end
    if "operator" in head[:end]:
        start = len(head[:end]) - 1 - head[:end][::-1].index("operator")
        if head[start - 1 : start] == ["::"]:
            start -= 1
    while start > 0:
        token = head[start - 1]
        if token == ">" and head[start : start + 1] == ["::"]:  # Name<Arguments>::member
            depth = 0
            while start > 0:
                depth += {">": 1, "<": -1}.get(head[start - 1], 0)
                start -= 1
                if depth == 0:
                    break
            continue
        word = re.match(r"\w", token) is not None
        if token in ("::", "~") or (word and (start == end or head[start] in ("::", "<"))):
            start -= 1
            continue
        break
    return "".join(head[start:end])


def split_at_commas(tokens):
    parts, part, depth, i = [], [], 0, 0
    while i < len(tokens):
        if tokens[i] in OPENING:
            end = matching(tokens, i)
            part += tokens[i:end]
            i = end
            continue
        depth += {"<": 1, ">": -1}.get(tokens[i], 0)
        if tokens[i] == "," and depth == 0:
            parts.append(part)
            part = []
        else:
            part.append(tokens[i])
        i += 1
    return parts + [part] if part else parts


def parameter_type(part):
    """A parameter without its name and default."""
    part = without_prefix(part)
    equals = top_level(part, {"="})
    part = part[:equals] if equals >= 0 else part
    types = [t for t in part if t not in QUALIFIERS]
    if (
        len(types) > 1
        and re.match(r"[A-Za-z_]", types[-1])
        and types[-1] not in BUILT_IN
        and types[-2] != "::"
    ):
        part = part[: len(part) - 1 - part[::-1].index(types[-1])]
    return " ".join(part)


class Scan:
    """The definitions of one file: {(what, name)}."""

    def __init__(self, text):
        self.tokens = tokens_of(text)
        self.found = set()
        self.declarations(0, [], in_class=False, hidden=False)

    def add(self, what, scope, name, hidden):
        if not hidden and name and name not in ONE_A_PROGRAM:
            self.found.add((what, "::".join([*scope, name])))

    def declarations(self, i, scope, in_class, hidden):
        """Reads up to the brace that closes the scope; returns the index behind it."""
        head = []  # of the declaration so far
        while i < len(self.tokens):
            token = self.tokens[i]
            if token == "}":
                return i + 1
            if token == ";":
                self.simple(head, scope, in_class, hidden)
                head = []
                i += 1
            elif token == ":" and in_class and len(head) == 1 and head[0] in (
                "public",
                "protected",
                "private",
            ):
                head = []
                i += 1
            elif token == "{":
                i, ended = self.brace(i, head, scope, in_class, hidden)
                head = [] if ended else [*head, "{", "}"]
            elif token in OPENING:
                end = matching(self.tokens, i)
                head += self.tokens[i:end]
                i = end
            else:
                head.append(token)
                i += 1
        return i

    def simple(self, head, scope, in_class, hidden):
        """A declaration without body: only variables are of interest."""
        if in_class or "inline" not in head or "using" in head or "namespace" in head:
            return
        head = without_prefix(head)
        end = top_level(head, {"=", "{", "("})
        if end < 0:
            end = len(head)
        if head[end : end + 1] != ["("] and "static" not in head:
            self.add("variable", scope, name_before(head, end), hidden)

    def brace(self, i, head, scope, in_class, hidden):
        """What the brace at i opens; the index behind it, and whether the declaration ends there."""
        if head[:1] == ["extern"] and head[1:] == ['""']:
            return self.declarations(i + 1, scope, in_class, hidden), True
        if "namespace" in head and "using" not in head:
            name = [t for t in head[head.index("namespace") + 1 :] if re.match(r"\w", t)]
            return self.declarations(i + 1, scope + name, False, hidden or not name), True
        plain = without_prefix(head)
        equals, parenthesis = top_level(plain, {"="}), top_level(plain, {"("})
        keys = [k for k, t in enumerate(plain) if t in TYPE_KEYS]
        if keys and equals < 0 and parenthesis < 0:
            # What follows is the name, then `final`, bases, or the type of an enum.
            rest = plain[keys[-1] + 1 :] if plain[keys[0]] == "enum" else plain[keys[0] + 1 :]
            colon = top_level(rest, {":"})
            rest = rest[:colon] if colon >= 0 else rest
            name = "".join(t for t in rest if t != "final")
            if plain[keys[0]] == "enum":
                self.add("type", scope, name, hidden)
                return matching(self.tokens, i), False
            self.add("type", scope, name, hidden)
            return self.declarations(i + 1, [*scope, name], True, hidden or not name), False
        is_function = parenthesis >= 0 and (equals < 0 or parenthesis < equals)
        if not is_function or self.initialises(plain, parenthesis):
            return matching(self.tokens, i), False
        if not in_class and "static" not in plain:
            end = matching(plain, parenthesis)
            types = [parameter_type(p) for p in split_at_commas(plain[parenthesis + 1 : end - 1])]
            constant = " const" if plain[end : end + 1] == ["const"] else ""
            name = name_before(plain, parenthesis)
            if name and name not in ONE_A_PROGRAM:
                self.add("function", scope, f"{name}({', '.join(types)}){constant}", hidden)
        return matching(self.tokens, i), True

    @staticmethod
    def initialises(head, parenthesis):
        """Whether a brace behind the head is a member's initialiser: Type(int x) : x_ {x} ..."""
        rest = head[matching(head, parenthesis) :]
        return ":" in rest and (re.match(r"\w", rest[-1]) is not None or rest[-1] == ">")


def repeated(files):
    """{name: files} of what several of {path: text} define."""
    where = {}
    for path, text in files.items():
        for what, name in Scan(text).found:
            where.setdefault(f"{what} {name}", []).append(path)
    return {name: sorted(paths) for name, paths in sorted(where.items()) if len(paths) > 1}


def self_test():
    a = """
      #pragma once
      #define BODY struct Defined { \\
        int x; }
      namespace symcell {
      struct Forward;
      class Later : public Base<int> { struct Inner { int y{1'000}; }; void f() { struct L {}; } };
      template <class T, class U = std::less<T>> struct Pair { T a; };
      template <> struct Pair<int> { int b; };
      enum class Kind : std::uint8_t { kA, kB };
      struct alignas(64) [[nodiscard]] Cavity { int edges; } one;
      const char* const kText = R"x(struct Raw { ")x"; // struct Comment {
      inline constexpr double kLimit = 1e-8;
      inline int half(int x) { return x / 2; }
      inline bool operator<(const Pair<int>& a, const Pair<int>& b) { return a.b < b.b; }
      namespace { struct Local {}; int helper(int) { return 1; } }
      static int hidden(int) { return 1; }
      Later::Later(int x) : Base<int>{x}, y_(x) { struct L {}; }
      auto table = [](int x) { return x; };
      struct Behind {};
      }
      int main() { return 0; }
    """
    b = """
      namespace symcell { struct Forward; class Cavity; struct Other { struct Inner {}; };
      template <class T, class U> struct Pair;
      template <> struct Pair<long> { long b; };
      namespace { struct Local {}; struct Behind {}; int helper(int) { return 2; } }
      static int hidden(int) { return 2; }
      inline double half(double x) { return x / 2; }
      inline bool operator<(const Other& a, const Other& b) { return &a < &b; }
      void Other::run(Cavity& c) const { struct L {}; const struct Forward* f = nullptr; }
      namespace deeper { struct Cavity {}; }
      std::vector<int> list{1, 2}; extern "C" { void c_function() {} }
      }
      int main() { return 1; }
    """
    c = """
      namespace symcell::deeper {}
      namespace symcell {
      struct Cavity final : Other { double edges; Cavity(int x) : edges{1}, v_(x) {} int v_; };
      enum Kind { kC };
      class Later::Inner { int z; };
      template <> struct Pair<int> { long b; };
      inline constexpr float kLimit{1};
      inline int half(int value = 3) { return value >> 1; }
      inline bool operator<(const Pair<int>& x, const Pair<int>& y) { return x.b < y.b; }
      }
    """
    assert repeated({"a": a, "b": b}) == {}, repeated({"a": a, "b": b})
    expected = [
        "function symcell::half(int)",
        "function symcell::operator<(const Pair < int > &, const Pair < int > &)",
        "type symcell::Cavity",
        "type symcell::Kind",
        "type symcell::Later::Inner",
        "type symcell::Pair<int>",
        "variable symcell::kLimit",
    ]
    found = repeated({"a": a, "c": c})
    assert list(found) == expected, list(found)
    assert found["type symcell::Cavity"] == ["a", "c"]
    names = {name for what, name in Scan(a).found if what == "type"}
    assert "symcell::Behind" in names and "Defined" not in names and "symcell::Raw" not in names


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return 0
    root = pathlib.Path(sys.argv[1])
    files = {
        str(path.relative_to(root)): path.read_text(encoding="utf-8")
        for folder in FOLDERS
        for path in sorted((root / folder).rglob("*.[ch]pp"))
    }
    if not files:
        print(f"{root}: no sources", file=sys.stderr)
        return 1
    twice = repeated(files)
    for name, paths in twice.items():
        print(f"{name}: defined in {', '.join(paths)}", file=sys.stderr)
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main())
