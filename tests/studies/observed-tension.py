"""The loss against an observation that was made at 12 N has its minimum there, and nothing of the solution knows of it."""

from study_run import expect, number, run


def test(study):
    study.expect_runs(7)
    expect(all(row["status"] == "converged" for row in study.rows), "a run has not converged")
    rows = sorted(study.rows, key=lambda row: number(row, "T_N"))
    values = [number(row, "distance_squared_mm2") for row in rows]
    least = min(range(len(rows)), key=lambda k: values[k])
    expect(number(rows[least], "T_N") == 12, f"the least distance is at {rows[least]['T_N']} N: {values}")
    # Two errors of 0.3 mm a place, less what the plan finds nearer.
    expect(0.02 < values[least] < 2 * 0.3**2 * 1.5, f"the observation's errors leave {values[least]} mm^2")
    falls = all(values[k] > values[k + 1] for k in range(least))
    rises = all(values[k] < values[k + 1] for k in range(least, len(values) - 1))
    expect(falls and rises, f"the distance does not fall to 12 N and rise from there: {values}")


run("observed-tension", test)
