"""Every shipped deck satisfies the JSON schema, decks with mistakes of structure do not. Standard library only.

usage: check_schema.py WHIRL REPOSITORY
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib


definitions = {}   # what "$ref" refers to


def errors(value, schema, path="deck"):
    """The mistakes of `value` under the part of JSON schema 2020-12 that the program writes."""
    if "$ref" in schema:
        assert set(schema) == {"$ref"} and schema["$ref"].startswith("#/$defs/"), schema
        return errors(value, definitions[schema["$ref"].removeprefix("#/$defs/").replace("%20", " ")], path)
    known = {"$schema", "$defs", "title", "description", "type", "properties", "required", "additionalProperties", "items", "minItems", "maxItems",
             "anyOf", "oneOf", "enum", "const", "pattern", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"}
    assert set(schema) <= known, f"{path}: this check does not know {set(schema) - known}"
    types = {"object": dict, "array": list, "string": str, "boolean": bool}
    found = []
    if "type" in schema:
        t = schema["type"]
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        good = (number if t == "number" else number and value == int(value) if t == "integer" else isinstance(value, types[t]))
        if not good:
            return [f"{path}: not of type {t}"]
    if "const" in schema and value != schema["const"]:
        found.append(f"{path}: not {schema['const']}")
    if "enum" in schema and value not in schema["enum"]:
        found.append(f"{path}: not one of {schema['enum']}")
    if "pattern" in schema and isinstance(value, str) and not re.search(schema["pattern"], value):
        found.append(f"{path}: does not match {schema['pattern']}")
    for key, bad in (("minimum", lambda a, b: a < b), ("maximum", lambda a, b: a > b),
                     ("exclusiveMinimum", lambda a, b: a <= b), ("exclusiveMaximum", lambda a, b: a >= b)):
        if key in schema and bad(value, schema[key]):
            found.append(f"{path}: violates {key} {schema[key]}")
    if isinstance(value, dict):
        for key in schema.get("required", []):
            if key not in value:
                found.append(f"{path}: lacks {key}")
        for key, v in value.items():
            if key in schema.get("properties", {}):
                found += errors(v, schema["properties"][key], f"{path}.{key}")
            elif schema.get("additionalProperties") is False:
                found.append(f"{path}: unknown {key}")
    if isinstance(value, list):
        if len(value) < schema.get("minItems", 0) or len(value) > schema.get("maxItems", len(value)):
            found.append(f"{path}: wrong number of items")
        for i, v in enumerate(value):
            found += errors(v, schema.get("items", {}), f"{path}[{i}]")
    if "anyOf" in schema:
        tries = [errors(value, s, path) for s in schema["anyOf"]]
        if all(tries):
            found += min(tries, key=len)
    if "oneOf" in schema:
        tries = [errors(value, s, path) for s in schema["oneOf"]]
        if sum(not t for t in tries) != 1:
            found += min(tries, key=len) or [f"{path}: fits more than one form"]
    return found


def decks_of_tests(root):
    """Whole decks that stand as text in the C++ tests: name and text."""
    for file in sorted(root.glob("tests/**/*.cpp")):
        for n, m in enumerate(re.finditer(r'R"(\w*)\((.*?)\)\1"', file.read_text(), re.DOTALL)):
            if "format = 1" in m[2]:
                yield f"{file.relative_to(root)} text {n + 1}", m[2]


# Codes of mistakes in the structure of a deck, which a schema sees; and the decks of tests/deck/bad with such a mistake where it does not, with why.
structure = {"E04", "E05", "E06", "E07", "E14", "E15", "E20", "E31"}
not_seen = {
    "E04_table_column": "the column of a CSV file",
    "E04_spelled_out_column": "titles of columns are texts",
    "E04_unknown_column": "titles of columns are texts",
    "E05_missing_column": "titles of columns are texts",
    "E05_no_material": "a material is needed where no other one stands",
    "E05_no_sections": "sections come in several ways",
    "E05_table_entries": "titles of columns are texts",
    "E07_missing_unit_in_title": "titles of columns are texts",
    "E07_set_is_checked": "the mistake is in --set",
    "E14_branch": "a range with a hole (0), and keys that go with another key's value",
    "E14_mode_numbers": "modes are numbers, or words",
    "E14_names": "characters of names that would be read as something else",
    "E20_keyphasor_bandwidth": "orders that a filter tells apart depend on its bandwidth",
    "E20_table_rows": "rows are lists of cells of any kind",
}


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2])
    text = subprocess.run([program, "schema"], check=True, capture_output=True, text=True).stdout
    assert len(text) < 600_000, f"the schema has {len(text)} characters: parts that repeat belong into $defs"
    schema = json.loads(text)
    definitions.update(schema["$defs"])
    decks = sorted(root.glob("examples/*/deck.toml")) + sorted(root.glob("tests/deck/good/*.toml"))
    assert len(decks) >= 5
    for deck in decks:
        value = tomllib.loads(deck.read_text())
        found = errors(value, schema)
        assert not found, (deck, found)
        resolved = subprocess.run([program, "check", "--resolved", str(deck)], check=True, capture_output=True, text=True).stdout
        found = errors(tomllib.loads(resolved), schema)
        assert not found, (deck, "resolved", found)

    # what the reader accepts the schema accepts
    accepted = 0
    for name, text in decks_of_tests(root):
        try:
            value = tomllib.loads(text)
        except tomllib.TOMLDecodeError:
            continue   # a part of one
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "deck.toml"
            file.write_text(text)
            if subprocess.run([program, "check", "--quiet", str(file)], capture_output=True, text=True).returncode != 0:
                continue
        accepted += 1
        found = errors(value, schema)
        assert not found, (name, found)
    assert accepted >= 10, accepted

    # what it can catch it catches
    for deck in sorted((root / "tests/deck/bad").glob("E*.toml")):
        if deck.stem.split("_")[0] not in structure:
            continue
        try:
            value = tomllib.loads(deck.read_text())
        except tomllib.TOMLDecodeError:
            continue
        assert bool(errors(value, schema)) != (deck.stem in not_seen), (deck.stem, not_seen.get(deck.stem))

    # the schema is no empty promise: mistakes are found
    good = tomllib.loads(decks[0].read_text())
    def broken(change):
        d = copy.deepcopy(good)
        change(d)
        assert errors(d, schema), change
    broken(lambda d: d.pop("format"))
    broken(lambda d: d.update(tittle="x"))
    broken(lambda d: d["disk"][0].update(mass=5))
    broken(lambda d: d["disk"][0].pop("at"))
    broken(lambda d: d["bearing"][0].update(type="linear"))
    broken(lambda d: d["bearing"][0].update(type="liner"))
    broken(lambda d: d["step"][0]["integrator"].update(method="euler"))
    broken(lambda d: d["step"][0]["integrator"].update(tolerance=2.0))
    broken(lambda d: d["output"].update(quantities=["sped"]))

    try:
        import jsonschema
    except ImportError:
        return
    validator = jsonschema.Draft202012Validator
    validator.check_schema(schema)
    for deck in decks:
        validator(schema).validate(tomllib.loads(deck.read_text()))


main()
