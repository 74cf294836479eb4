#!/usr/bin/env python3
"""Whether the schema says what the parser does, and takes what comes with the program. usage: schema_test.py PROGRAM SWEEP"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

from program import SOURCE


class Loader(yaml.SafeLoader):
    """Numbers, flags and nothing else as YAML 1.2 has them, like the editors' servers and the parser."""


Loader.yaml_implicit_resolvers = {}
NUMBER = re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$")
for tag, pattern, first in (("bool", re.compile(r"^(true|false)$"), "tf"),
                            ("int", re.compile(r"^[-+]?[0-9]+$"), "-+0123456789"),
                            ("float", NUMBER, "-+.0123456789"),
                            ("null", re.compile(r"^(~|null|)$"), ["~", "n", ""])):
    Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", pattern, first)


def load(text):
    return yaml.load(text, Loader)


def run(program, *arguments, folder=None):
    """Exit code, output, errors."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=60, cwd=folder)
    return done.returncode, done.stdout, done.stderr


def check_schema(program):
    """The schema is one and takes all cases that come with the program."""
    code, text, _ = run(program, "schema")
    assert code == 0
    schema = json.loads(text)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    cases = [path for path in sorted((SOURCE / "configs").rglob("*.yaml"))]
    assert len(cases) > 30
    for case in cases:
        errors = list(validator.iter_errors(load(case.read_text())))
        assert not errors, (case, errors[0])
    return validator


def check_sweep(validator, sweep):
    """Parser and schema take and refuse the same values of every key."""
    done = subprocess.run([sweep], capture_output=True, text=True, timeout=60, check=True)
    counts = {"yes": 0, "no": 0}
    for line in done.stdout.splitlines():
        verdict, case = line.split(" ", 1)
        valid = validator.is_valid(load(case))
        assert valid == (verdict == "yes"), f"parser: {verdict}, schema: {valid}: {case}"
        counts[verdict] += 1
    assert counts["yes"] > 300 and counts["no"] > 800, counts
    print("parser and schema agree on", counts)


def check_descriptions(validator):
    """An editor shows a text for every key."""
    def visit(path, schema):
        assert schema["description"].endswith(".") and "](" not in schema["description"], path
        for name, below in schema.get("properties", {}).items():
            visit(f"{path}.{name}", below)
    visit("", validator.schema)
    sizing = validator.schema["properties"]["sizing"]["properties"]
    assert sizing["growth"]["minimum"] == 1.01 and sizing["growth"]["default"] == 1.3
    assert "from the model" in sizing["minimum"]["description"]
    assert "interface_angle" not in json.dumps(validator.schema)


def check_init(program, validator):
    """The schema takes what init writes, short and long."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    for options in (("--geometry", "wing.step"), ("--force", "--full")):
        code, said, errors = run(program, "init", *options, folder=folder)
        case = load((folder / "case.yaml").read_text())
        assert code == 0 and validator.is_valid(case), (case, said, errors)
        if "wing.step" in options:
            assert case["geometry"] == {"file": "wing.step"}, case
    assert json.loads((folder / "aeroloom.schema.json").read_text()) == validator.schema


def main():
    program, sweep = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    validator = check_schema(program)
    check_descriptions(validator)
    check_sweep(validator, sweep)
    check_init(program, validator)
    print("schema: ok")


if __name__ == "__main__":
    main()
