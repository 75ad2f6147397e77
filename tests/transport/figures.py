#!/usr/bin/env python3
"""The figure of plan switches that ships is the one that its program draws.

    figures.py SOURCE_ROOT WALK_PLANS
"""
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

SVG = "{http://www.w3.org/2000/svg}"


def switches(file):
    return [path for path in xml.parse(file).iter(SVG + "path") if path.get("class") == "subgradients"]


def main():
    root, program = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        drawn = pathlib.Path(folder) / "switches.svg"
        subprocess.run([sys.executable, root / "docs" / "make_transport_figures.py", "switches", program, drawn], check=True)
        now, shipped = switches(drawn), switches(root / "docs" / "transport-switches.svg")
    assert len(now) > 10, f"{len(now)} switches drawn"
    assert len(now) == len(shipped), f"{len(now)} switches drawn, {len(shipped)} in docs/transport-switches.svg: draw it anew"
    print(f"{len(now)} switches drawn, as in docs/transport-switches.svg")


if __name__ == "__main__":
    main()
