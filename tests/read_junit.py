"""Reads the JUnit XML of --junit as Jenkins and GitLab do, and holds it against the figures of --json.

usage: read_junit.py --command SCAN2FEA --scan SCAN.ply
Prints what is wrong; exit status 1 if anything is.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

from expectations import expect, wrong


def read(file):
    """What Jenkins' JUnit plugin and GitLab's parser take: suites, and of each case name, classname, file, time, and
    failure, error or skipped."""
    root = ElementTree.parse(file).getroot()
    expect(root.tag == "testsuites", f"root is {root.tag}")
    cases = []
    for suite in root.iter("testsuite"):
        own = suite.findall("testcase")
        expect(int(suite.get("tests")) == len(own), "the suite counts its cases")
        expect(int(suite.get("failures")) == sum(c.find("failure") is not None for c in own), "and its failures")
        expect(suite.get("errors") == "0" and suite.get("skipped") == "0" and suite.get("name"), "and has a name")
        cases += own
    expect(int(root.get("tests")) == len(cases), "the root counts all cases")
    for case in cases:
        expect(all(case.get(key) for key in ("name", "classname", "file")), f"{case.attrib} is told apart")
        float(case.get("time"))
    # GitLab knows a case by class and name: two of the same would be one.
    expect(len({(c.get("classname"), c.get("name")) for c in cases}) == len(cases), "all cases are told apart")
    return cases


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", required=True)
    parser.add_argument("--scan", required=True)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        part, xml, figures = (os.path.join(folder, name) for name in ("part.inp", "gates.xml", "figures.json"))

        def run(*command, code):
            ran = subprocess.run([arguments.command, *command, "--quiet", "--force"], capture_output=True, text=True)
            expect(ran.returncode == code, f"{command}: exit {ran.returncode}, {ran.stderr}")

        run("run", arguments.scan, "-o", part, "--faces", "2000", "--gates", "abaqus", "--gates", "paper", "--junit", xml,
            code=0)
        cases = read(xml)
        expect(len(cases) > 5 and all(c.find("failure") is None for c in cases), "all gates of the sets pass")
        expect(os.path.exists(part), "the mesh is there")

        run("check", part, "--reference", arguments.scan, "--gates", "abaqus", "--require", "edge_ratio.mean<=1.01",
            "--require", "scaled_jacobian.min>=0.99", "--require", "genus>=0", "--junit", xml, "--json", figures, code=1)
        cases = read(xml)
        with open(figures) as file:
            gates = json.load(file)["gates"]
        expect(len(cases) == len(gates), "a case for each gate")
        for case, gate in zip(cases, gates):
            failure = case.find("failure")
            expect(case.get("name").startswith(f"{gate['name']} {gate['operator']} "), f"{case.get('name')}")
            expect((failure is None) == gate["pass"], f"{gate} is as in the XML")
            if failure is None:
                continue
            expect(failure.get("type") == "gate" and failure.text, "a failure has a type and a text")
            message = failure.get("message")
            expect(repr(gate["value"]).removesuffix(".0") in message, f"{message} tells {gate['value']}")
            expect(repr(gate["limit"]).removesuffix(".0") in message, f"{message} tells {gate['limit']}")
            if "place" in gate:
                expect(f"element {gate['element']}" in message and " at (" in message, f"{message} tells where")
        failed = {gate["name"]: gate for gate in gates if not gate["pass"]}
        expect(set(failed) == {"surface.edge_ratio.mean", "volume_mesh.scaled_jacobian.min"}, f"failed: {set(failed)}")
        with open(figures) as file:
            worst = json.load(file)["worst_elements"]["elements"][0]
        expect(failed["volume_mesh.scaled_jacobian.min"]["element"] == worst["element"], "the element is the worst one")
        expect(failed["volume_mesh.scaled_jacobian.min"]["place"] == worst["place"], "and so is its place")

        # A gate that fails leaves the XML, and no mesh.
        made = os.path.join(folder, "none.stl")
        run("surface", arguments.scan, "-o", made, "--faces", "1000", "--require", "faces<=1", "--junit", xml, code=1)
        expect([c.find("failure") is not None for c in read(xml)] == [True], "the gate failed")
        expect(not os.path.exists(made), "a failed gate leaves no mesh")
    sys.exit(1 if wrong else 0)


main()
