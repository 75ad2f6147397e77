"""Files of hard cases: what they hold (README.md has the format), made into scenes for the grid's runner, and the
judgement of a result document by what its run expects."""

import csv
import dataclasses
import os
import pathlib
import re
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "grid"))

import results  # noqa: E402
import scenes  # noqa: E402

NATIVE_SOLVERS = ("interior-point", "active-set")
REFERENCE_SOLVER = "ipopt"
REFUSED = "refused"

CASE_KEYS = {"why", "composition", "data", "full", "run", "agree"}
RUN_KEYS = {"name", "each", "set", "start", "full", "data", "verdict", "says", "expect", "monotone", "known-shortfall"}
SHORTFALL_KEYS = {"solver", "each", "happens", "recheck"}
AGREE_KEYS = {"runs", "path", "relative", "absolute"}
EXPECT_KEYS = {"is", "contains", "value", "relative", "absolute", "at-most", "at-least"}


class WrongCase(Exception):
    """A case file that cannot be read as one: what was found, what was expected."""


@dataclasses.dataclass(frozen=True)
class Run:
    """One scene with its expectation. `first`: of those that its entry makes; `shortfalls`: {solver: what happens
    instead}; `recheck_shortfalls`: {solver: why the re-check takes a `converged` for none}."""

    case: str
    name: str
    scene: scenes.Scene
    full: bool
    first: bool
    verdicts: tuple
    says: str
    expect: dict
    monotone: tuple
    shortfalls: dict
    recheck_shortfalls: dict


@dataclasses.dataclass(frozen=True)
class Case:
    name: str
    why: str
    runs: tuple
    agreements: tuple
    skip: str


def check_keys(where, table, known):
    for key in table:
        if key not in known:
            raise WrongCase(f"{where}: unknown key '{key}'; expected one of {', '.join(sorted(known))}")


def geometric(count, ratio):
    """Fractions of a length for `count` edges, each longer than the one before, the last `ratio` times the first."""
    lengths = [ratio ** (i / (count - 1)) for i in range(count)]
    return [length / sum(lengths) for length in lengths]


def alternating(count, ratio):
    """Fractions for `count` edges, long and short in turn."""
    lengths = [ratio if i % 2 == 0 else 1.0 for i in range(count)]
    return [length / sum(lengths) for length in lengths]


SPACINGS = {"geometric": geometric, "alternating": alternating}


def spacing(match):
    fractions = SPACINGS[match[1]](int(match[2]), float(match[3]))
    return "[" + ", ".join(f"{fraction:.17g}" for fraction in fractions) + "]"


def without_repeated_points(source, target, least=1e-6):
    """Copies points of a centerline but those nearer than `least` mm to the one before: no curve has an edge of
    length 0."""
    kept = None
    with open(source, encoding="utf-8", newline="") as text, open(target, "w", encoding="utf-8", newline="") as out:
        lines = (line for line in text if not line.startswith("#"))
        rows = csv.reader(lines)
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(next(rows))
        for row in rows:
            place = [float(number) for number in row[:3]]
            if kept is None or sum((a - b) ** 2 for a, b in zip(place, kept)) > least ** 2:
                writer.writerow(row)
                kept = place


class Reader:
    """Reads case files; texts and points that a case brings along are written into `folder`."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.data = os.environ.get(scenes.DATA, "")

    def filled(self, text, each, points):
        text = text.replace("{each}", each).replace("{scenes}", str(scenes.ROOT / "scenes"))
        text = text.replace("{points}", points)
        return re.sub(r"\{(geometric|alternating):(\d+):([0-9.e+-]+)\}", spacing, text)

    def points(self, case, data, each):
        """A copy of a data file without repeated points, or "" where there is no data."""
        if not data or not self.data:
            return ""
        source = pathlib.Path(self.data).resolve() / data.replace("{each}", each)
        if not source.exists():
            raise WrongCase(f"{case}: {scenes.DATA} has no file {source}")
        self.folder.mkdir(parents=True, exist_ok=True)
        target = self.folder / f"{case}-{source.stem}.csv"
        without_repeated_points(source, target)
        return str(target)

    def composition(self, case, file, text):
        if "\n" not in text:
            return (file.parent / text).resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        place = self.folder / f"{case}.composition.toml"
        place.write_text(self.filled(text, "", ""), encoding="utf-8")
        return place

    def case(self, file):
        file = pathlib.Path(file)
        name = file.stem
        try:
            table = tomllib.loads(file.read_text(encoding="utf-8"))
        except ValueError as error:
            raise WrongCase(f"{file}: {error}") from error
        check_keys(name, table, CASE_KEYS)
        for key in ("why", "composition", "run"):
            if not table.get(key):
                raise WrongCase(f"{name}: '{key}' is missing; expected why it is hard and what is true, a composition, "
                                "runs")
        composition = self.composition(name, file, table["composition"])
        data = table.get("data", "")
        skip = f"{scenes.DATA} is not set" if data and not self.data else ""
        runs = [run for entry in table["run"] for run in self.runs(name, entry, composition, data, skip,
                                                                   table.get("full", False))]
        names = [run.name for run in runs]
        for duplicate in {run for run in names if names.count(run) > 1}:
            raise WrongCase(f"{name}: two runs are called '{duplicate}'; expected a name for each")
        for agreement in table.get("agree", ()):
            check_keys(f"{name}: [[agree]]", agreement, AGREE_KEYS)
            for run in agreement["runs"]:
                if run not in names:
                    raise WrongCase(f"{name}: [[agree]] names '{run}'; expected one of {', '.join(names)}")
        return Case(name, " ".join(table["why"].split()), tuple(runs), tuple(table.get("agree", ())), skip)

    def runs(self, case, entry, composition, data, skip, full):
        check_keys(f"{case}: [[run]]", entry, RUN_KEYS)
        for key in ("name", "verdict"):
            if key not in entry:
                raise WrongCase(f"{case}: a [[run]] without '{key}'")
        for number, each in enumerate(entry.get("each", [""])):
            name = f"{entry['name']} {each}".strip() if "{each}" not in entry["name"] else entry["name"].replace(
                "{each}", each)
            points = self.points(case, data, each)
            overrides = tuple((path, self.filled(value, each, points))
                              for path, value in entry.get("set", {}).items())
            after = self.scene_name(case, entry["start"]) if "start" in entry else ""
            scene = scenes.Scene(case, self.scene_name(case, name), (), composition, overrides, after, skip)
            verdicts = entry["verdict"] if isinstance(entry["verdict"], list) else [entry["verdict"]]
            shortfalls, rechecks = {}, {}
            for shortfall in entry.get("known-shortfall", ()):
                check_keys(f"{case}: known-shortfall", shortfall, SHORTFALL_KEYS)
                if not shortfall.get("each") or each in shortfall["each"]:
                    marks = rechecks if shortfall.get("recheck") else shortfalls
                    every = (*NATIVE_SOLVERS, REFERENCE_SOLVER)
                    for solver in [shortfall["solver"]] if "solver" in shortfall else every:
                        marks[solver] = shortfall["happens"]
            for path, wanted in entry.get("expect", {}).items():
                check_keys(f"{case}: {name}: {path}", wanted, EXPECT_KEYS)
            yield Run(case, name, scene, full or entry.get("full", False), number == 0,
                      tuple(verdicts), entry.get("says", ""),
                      entry.get("expect", {}), tuple(entry.get("monotone", ())), shortfalls, rechecks)

    @staticmethod
    def scene_name(case, run):
        return case + "-" + re.sub(r"[^A-Za-z0-9.+-]+", "-", run).strip("-")


def looked_up(document, path):
    """The value at a path, entries of lists by number (negative from the end), "*" for all of a list. None: absent."""
    keys = path.split(".")
    for number, key in enumerate(keys):
        if key == "*" and isinstance(document, list):
            rest = ".".join(keys[number + 1:])
            return [looked_up(entry, rest) if rest else entry for entry in document]
        if isinstance(document, list):
            index = int(key)
            if not -len(document) <= index < len(document):
                return None
            document = document[index]
        elif isinstance(document, dict) and key in document:
            document = document[key]
        else:
            return None
    return document


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def text_of(value):
    return f"{value:.8g}" if is_number(value) else str(value)[:300]


def unmet(value, wanted):
    """What a value lacks of an expectation (the keys are EXPECT_KEYS), "" if nothing."""
    if "is" in wanted and value != wanted["is"]:
        return f"expected {wanted['is']}"
    if "contains" in wanted and wanted["contains"] not in str(value):
        return f"expected to contain '{wanted['contains']}'"
    numeric = {"value", "at-most", "at-least"} & wanted.keys()
    if numeric and not is_number(value):
        return "expected a number"
    if "value" in wanted:
        allowed = wanted["relative"] * abs(wanted["value"]) if "relative" in wanted else wanted["absolute"]
        if not abs(value - wanted["value"]) <= allowed:
            return f"expected {text_of(wanted['value'])} ± {text_of(allowed)}"
    if "at-most" in wanted and not value <= wanted["at-most"]:
        return f"expected at most {text_of(wanted['at-most'])}"
    if "at-least" in wanted and not value >= wanted["at-least"]:
        return f"expected at least {text_of(wanted['at-least'])}"
    return ""


def first_fall(values):
    """Where a list does not rise strictly, in words; "" where it does. Entries that are null are left out."""
    numbers = [value for value in values or () if value is not None]
    if len(numbers) < 2:
        return "expected two numbers or more"
    for number, (before, after) in enumerate(zip(numbers, numbers[1:])):
        if not after > before:
            return f"falls from {text_of(before)} to {text_of(after)} at entry {number + 1}"
    return ""


def faults(run, row, document):
    """What is not as the run expects, as texts; none: all is."""
    out = []
    if row["status"] not in run.verdicts:
        out.append(f"{row['status']}, expected {' or '.join(run.verdicts)}")
    # The words are those of the native solvers, which are what is demanded.
    if run.says and row["solver"] in NATIVE_SOLVERS and run.says not in (row["reason"] or ""):
        out.append(f"says '{(row['reason'] or '')[:200]}', expected to contain '{run.says}'")
    if row["status"] in results.NO_DOCUMENT:
        return out
    # The figures are those of the equilibrium; another verdict that is allowed has none.
    if row["status"] != run.verdicts[0]:
        return out
    for path, wanted in run.expect.items():
        value = looked_up(document, path)
        lacks = "not in the result" if value is None and wanted.get("is", "") is not None else unmet(value, wanted)
        if lacks:
            out.append(f"{path} = {text_of(value)}, {lacks}")
    for path in run.monotone:
        fall = first_fall(looked_up(document, path))
        if fall:
            out.append(f"{path}: {fall}")
    return out


def disagreement(agreement, documents):
    """What is wrong between runs, "" if nothing; None where one was not run or did not end with figures."""
    path = agreement["path"]
    values = [looked_up(documents.get(run), path) if documents.get(run) else None for run in agreement["runs"]]
    if any(not is_number(value) for value in values):
        return None
    spread = max(values) - min(values)
    allowed = agreement.get("absolute", agreement.get("relative", 0.0) * abs(values[0]))
    if spread <= allowed:
        return ""
    return (f"{path} of {', '.join(agreement['runs'])}: {', '.join(map(text_of, values))}; expected within "
            f"{text_of(allowed)}")
