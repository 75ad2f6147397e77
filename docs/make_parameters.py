"""Prints docs/parameters.md from what the plugins of a build declare: python3 docs/make_parameters.py build/bowstring"""

import json
import subprocess
import sys


def ask(bowstring, *arguments):
    return json.loads(subprocess.run([bowstring, *arguments, "--json"], check=True, stdout=subprocess.PIPE).stdout)


def unit(text):
    return " or ".join(part or "a bare number" for part in text.split("|")) if text else ""


def bounds(parameter):
    parts = []
    if parameter["choices"]:
        parts.append(" / ".join(f"`{choice}`" for choice in parameter["choices"].split("|")))
    if parameter["lower"] is not None:
        parts.append(("> " if parameter["lower_exclusive"] else "≥ ") + f"{parameter['lower']:g}")
    if parameter["upper"] is not None:
        parts.append(f"≤ {parameter['upper']:g}")
    return ", ".join(parts)


def default(parameter):
    if parameter["required"]:
        return "required"
    return "optional" if parameter["default"] is None else f"`{parameter['default']}`"


def rows(parameters, prefix=""):
    for parameter in parameters:
        yield [f"`{prefix}{parameter['key']}`", parameter["type"], unit(parameter["unit"]), bounds(parameter),
               default(parameter), parameter["description"]]
        yield from rows(parameter.get("items", []), f"{prefix}{parameter['key']}[].")


def main(bowstring):
    print("# Parameters of every plugin\n")
    print("From the plugins' own declarations, by `docs/make_parameters.py`; `bowstring describe KIND/NAME` says the same.")
    for plugin in ask(bowstring, "plugins"):
        name = f"{plugin['kind']}/{plugin['name']}"
        described = ask(bowstring, "describe", name)
        print(f"\n## {name}\n\n{described['description']}.")
        if not described["parameters"]:
            continue
        print("\n| key | type | unit | bounds | default | |\n|---|---|---|---|---|---|")
        for row in rows(described["parameters"]):
            print("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |")


if __name__ == "__main__":
    main(*sys.argv[1:])
