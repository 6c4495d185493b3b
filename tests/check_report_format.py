"""Holds the figures that the command writes against report.schema.json, and the schema against its version.

usage: check_report_format.py --command SCAN2FEA --scan SCAN.ply --schema SCHEMA.json --figures FOLDER
FOLDER: figures that other tests have left; they are taken away. Prints what is wrong; exit status 1 if anything is, 77
where python3-jsonschema is not installed.
"""
import argparse
import copy
import glob
import hashlib
import json
import os
import subprocess
import sys
import tempfile

from expectations import expect, wrong

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

# The schema of each version of the format, without its words: whoever changes the format gives it a new version, in
# quality/report.hpp and in the schema, and a line here.
formats = {
    "scan2fea/2": "32f7bc33682e569d8f094d26ec03704aa3d03b5160602dae87d9cf171aeab045",
    "scan2fea/3": "756478214f0dbe022e285fa58727734eb02dafec2929f611e401f663247c956e",
    "scan2fea/4": "8fb091ccfef85fa6e28e93c92b0f85b6830110809d0481c04cb117d31a8382b3",
    "scan2fea/5": "e4e795b5f99844239c092aa2ffd48267e410a7324b8d8e640253927fdccf1809",
    "scan2fea/6": "2cf6176c0f75dced07e6312e05cf0e54605b20cffa20c4791f06d5da688f557b",
}


def expect_valid(validator, report, name):
    for error in validator.iter_errors(report):
        cause = jsonschema.exceptions.best_match([error])  # within the kinds of stages
        expect(False, f"{name}: {error.json_path}: {cause.json_path}: {cause.message[:200]}")


def without_words(schema):
    if isinstance(schema, list):
        return [without_words(entry) for entry in schema]
    if not isinstance(schema, dict):
        return schema
    return {key: without_words(value) for key, value in schema.items()
            if not (key in ("description", "title") and isinstance(value, str))}


def fingerprint(schema):
    return hashlib.sha256(json.dumps(without_words(schema), sort_keys=True).encode()).hexdigest()


def figures_of_commands(command, scan):
    with tempfile.TemporaryDirectory() as folder:
        part, surface = os.path.join(folder, "part.inp"), os.path.join(folder, "part.stl")
        for arguments in (["run", scan, "-o", part, "--faces", "2000", "--unit", "mm", "--set", "foot=z<3mm", "--slide", "0.1%"],
                          ["run", scan, "-o", os.path.join(folder, "c.vtu"), "--faces", "2000", "--layers", "2:0.3:1.2"],
                          ["surface", scan, "-o", surface, "--faces", "2000", "--enrich"],
                          ["repair", scan, "-o", os.path.join(folder, "repaired.ply")],
                          ["run", scan, "-o", os.path.join(folder, "b.vtu"), "--faces", "1500", "--order", "2"],
                          ["faces", part], ["check", surface], ["compare", part, surface],
                          ["compare", part, os.path.join(folder, "b.vtu"), "--reference", scan], ["check", part, "--reference", scan],
                          ["check", scan, "--require", "edge_ratio.mean<=1.0"],
                          ["check", part, "--gates", "abaqus", "--require", "edge_ratio.mean<=1.0", "--require", "genus>=9"]):
            run = subprocess.run([command, *arguments, "--json", "-", "--quiet"], capture_output=True, text=True)
            expect(run.returncode in (0, 1), f"{arguments}: exit {run.returncode}, {run.stderr}")
            yield " ".join(arguments), json.loads(run.stdout)


def main():
    parser = argparse.ArgumentParser()
    for flag in ("--command", "--scan", "--schema", "--figures"):
        parser.add_argument(flag, required=True)
    arguments = parser.parse_args()
    with open(arguments.schema) as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    version = schema["properties"]["schema"]["const"]
    expect(formats.get(version) == fingerprint(schema),
           f"the schema of {version} has changed ({fingerprint(schema)}): give the format a new version")

    validator = jsonschema.Draft202012Validator(schema)
    count = 0
    for name, report in figures_of_commands(arguments.command, arguments.scan):
        expect_valid(validator, report, name)
        count += 1
        for change in (lambda r: r.update(new_key=1), lambda r: r.pop("gates"), lambda r: r.update(schema="scan2fea/0")):
            changed = copy.deepcopy(report)
            change(changed)
            expect(not validator.is_valid(changed), f"{name}: a changed format is noticed")
    for file in glob.glob(os.path.join(arguments.figures, "*.json")):
        with open(file) as stream:
            expect_valid(validator, json.load(stream), file)
        os.remove(file)
        count += 1
    print(f"{count} reports have the format {version}")
    sys.exit(1 if wrong else 0)


main()
