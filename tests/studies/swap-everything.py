"""Every plugin that a composition can name has been in a run of this study that converged."""

import json
import math

from study_run import expect, number, run

KINDS = {"geometry", "kinematics", "energy", "constraint", "enforcement", "solver", "transport", "ground-cost"}


def test(study):
    stuck = [f"{row['run']}: {row['status']}, {row['reason']}" for row in study.rows if row["status"] != "converged"]
    expect(not stuck, "; ".join(stuck))
    documents = study.documents()
    expect(len(documents) == len(study.rows), f"{len(documents)} documents of {len(study.rows)} runs")
    used = {(plugin["kind"], plugin["name"]) for document in documents for plugin in document["provenance"]["plugins"]}
    shipped = {(plugin["kind"], plugin["name"]) for plugin in json.loads(study.command("plugins", "--json"))}
    missing = sorted(f"{kind}/{name}" for kind, name in shipped - used if kind in KINDS)
    expect({kind for kind, _ in shipped} >= KINDS, "`bowstring plugins --json` lacks a kind")
    expect(not missing, "studies/swap-everything.toml has no run with " + ", ".join(missing) +
           "; add an alternative to the axis of its kind")

    base = number(study.rows[0], "energy_total_N_mm")
    for choice in [{"kinematics": "nodes"}, {"energy": "extravascular"}, {"enforcement": "augmented-lagrangian"},
                   {"solver": "active-set"}, {"solver": "ipopt"}, {"solver": "nlopt"}]:
        found = number(study.one(**choice), "energy_total_N_mm")
        expect(abs(found - base) < 1e-8 * base, f"{choice}: {found} N mm instead of {base}")
    expect_losses(documents)

    expect_closed_form(study, 0.00418951, "peak_displacement_mm", 2e-4, geometry="line")
    # M²L/2EI less the half segment at the rod's end, which has no bending of its own
    expect_closed_form(study, -4.975, "energy_total_N_mm", 1e-9, energy="dead-moment")
    # 32 K (E − ¾ K) EI/L, k = 1/2
    first, second = complete_elliptic(0.25)
    expect_closed_form(study, 32 * first * (second - 0.75 * first) * 10, "energy_total_N_mm", 1e-3,
                       solver="trust-region")


def expect_losses(documents):
    """Every transport and ground cost has a value of the same solution, and the two exact methods have the same one."""
    observed = [document for document in documents if document["losses"]]

    def plugin(document, key):
        return document["composition"]["loss"][0][key]["type"]

    def without_loss(document):
        return {key: value for key, value in document["composition"].items() if key != "loss"}

    lemon = next(document for document in observed if plugin(document, "transport") == "exact-lemon")
    values = {(plugin(document, "transport"), plugin(document, "ground-cost")): document["losses"][0]["value"]
              for document in observed if without_loss(document) == without_loss(lemon)}
    expect(all(value is not None and value > 0 for value in values.values()), f"losses: {values}")
    exact = values["exact", "euclidean"]
    expect(abs(values["exact-lemon", "euclidean"] - exact) < 1e-10 * exact, f"losses: {values}")


def expect_closed_form(study, value, column, tolerance, **choice):
    found = number(study.one(**choice), column)
    expect(abs(found - value) < tolerance * abs(value), f"{choice}: {column} is {found} instead of {value}")


def complete_elliptic(m):
    """K(m) and E(m) by the arithmetic-geometric mean."""
    a, b, c, weight, total = 1.0, math.sqrt(1 - m), math.sqrt(m), 0.5, 0.5 * m
    while abs(c) > 1e-16:
        a, b, c, weight = (a + b) / 2, math.sqrt(a * b), (a - b) / 2, 2 * weight
        total += weight * c * c
    first = math.pi / (2 * a)
    return first, first * (1 - total)


run("swap-everything", test)
