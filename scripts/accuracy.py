#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""The accuracy tables of docs/accuracy.md, measured with the release binary: prints them and writes
build/release/bench/accuracy.json (rows as those of the benchmarks). Standard library only; about two minutes."""

import csv
import json
import math
import subprocess
import tempfile
import time
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DERMIS = ROOT / "build/release/bin/dermis"
DSA = ROOT.parent / "shared/data/dsa_weights"
KPA_PER_NEWTON = 9.07  # over the contact area of the weights, 110 mm2

rows = []


def dermis(*arguments):
    done = subprocess.run([DERMIS, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    return done.stdout


def array_toml(folder, size, circuit="divider", drive_ohm=20, load_ohm=200):
    path = folder / "array.toml"
    path.write_text(
        f"[array]\nrows = {size[0]}\ncols = {size[1]}\ntaxel_area_mm2 = 38.48\n"
        f'[readout]\ncircuit = "{circuit}"\ndrive_ohm = {drive_ohm}\nload_ohm = {load_ohm}\n'
        "adc_bits = 12\nadc_reference_v = 5.0\nsupply_v = 5.0\n"
    )
    return path


def simulate(folder, array, scene, seed, physics=None):
    arguments = ["--physics", physics] if physics else []
    dermis("simulate", "--array", array, "--scene", scene, "--seed", seed, "--out", folder / scene, *arguments)
    return folder / scene


def calibrate(folder, array, recording):
    model = folder / "model.safetensors"
    start = time.monotonic()
    dermis(
        "calibrate",
        "--array",
        array,
        "--frames",
        recording / "frames.csv",
        "--loads",
        recording / "loads.csv",
        "--out",
        model,
    )
    return model, time.monotonic() - start


def evaluate(model, recording):
    return json.loads(
        dermis(
            "evaluate",
            "--json",
            "--model",
            model,
            "--frames",
            recording / "frames.csv",
            "--loads",
            recording / "loads.csv",
        )
    )


def report(work, result):
    estimators = result["estimators"]
    print(f"\n{work}\n  {'estimator':20}{'median %':>10}{'p95 %':>10}{'p99 %':>10}{'max %':>10}{'ghost p99 N':>13}")
    for result in estimators:
        shares = [100 * result[f"{key}_relative_error"] for key in ("median", "p95", "p99", "max")]
        ghost = f"{result['ghost_p99_n']:13.3f}" if result["ghost_p99_n"] is not None else f"{'-':>13}"
        print(f"  {result['name']:20}" + "".join(f"{share:10.2f}" for share in shares) + ghost)
        row(
            work,
            result["name"],
            shares[0],
            "% median error",
            p95=shares[1],
            p99=shares[2],
            max=shares[3],
            ghost_p99_n=result["ghost_p99_n"],
        )
    report_coverage(work, result)


def report_coverage(work, result):
    """How often the true force is within the 68 % and 95 % intervals of dermis."""
    dermis_result = result["estimators"][0]
    cover_68, cover_95 = (100 * dermis_result[f"coverage_{share}"] for share in (68, 95))
    print(
        f"  68 % intervals cover {cover_68:.1f} %, 95 % intervals {cover_95:.1f} % of "
        f"{dermis_result['coverage_taxels']} taxels"
    )
    for breakdown in ("by_force", "by_contacts"):
        bins = [(b, b["estimators"]["dermis"]) for b in result[breakdown]]
        print(
            f"    {breakdown}: "
            + ", ".join(
                f"{b['from']:g}-{b['to']:g}: {100 * of['coverage_68']:.0f} / {100 * of['coverage_95']:.0f}"
                for b, of in bins
                if of["coverage_68"] is not None
            )
        )
    row(f"{work}: 68 % interval", "dermis", cover_68, "% covered")
    row(f"{work}: 95 % interval", "dermis", cover_95, "% covered")
    bound = result.get("cramer_rao_bound")
    if bound:
        share, deviation = 100 * bound["median_relative_bound"], 100 * bound["median_relative_deviation"]
        print(
            f"  Cramer-Rao bound of the ADC noise {share:.2f} %, dermis {deviation:.2f} % (median of "
            f"{bound['taxels']} taxels)"
        )
        row(f"{work}: Cramer-Rao bound of the ADC noise", "bound", share, "% median", dermis=deviation)


def row(work, engine, median, unit, **more):
    rows.append({"work": work, "engine": engine, "threads": 2, "median": median, "unit": unit, "checked": True, **more})


def single_presses(folder):
    cases = [
        ("16x16, 20 ohm / 200 ohm", (16, 16), {}),
        ("12x10, 10 ohm / 470 ohm", (12, 10), {"drive_ohm": 10, "load_ohm": 470}),
        ("8x8, 30 ohm / 330 ohm", (8, 8), {"drive_ohm": 30, "load_ohm": 330}),
        ("32x32, 20 ohm / 200 ohm", (32, 32), {}),
        (
            "16x16 transimpedance, 25 ohm / 150 ohm",
            (16, 16),
            {"circuit": "transimpedance", "drive_ohm": 25, "load_ohm": 150},
        ),
    ]
    for name, size, readout in cases:
        array = array_toml(folder, size, **readout)
        model, seconds = calibrate(folder, array, simulate(folder, array, "calibration", 1))
        report(f"{name}: multitouch after single presses", evaluate(model, simulate(folder, array, "multitouch", 2)))
        print(f"  calibrated in {seconds:.1f} s")
        row(f"{name}: calibration", "dermis", seconds, "s")
        if size == (16, 16) and not readout:
            report(f"{name}: the paper's 48 points", evaluate(model, simulate(folder, array, "paper", 3)))


def other_calibrations(folder):
    array = array_toml(folder, (16, 16))
    multitouch = simulate(folder, array, "multitouch", 2)
    model, _ = calibrate(folder, array, simulate(folder, array, "uniform", 4))
    report("16x16: multitouch after an air bladder of 15-700 kPa", evaluate(model, multitouch))
    model, _ = calibrate(folder, array, load_cell_recording(folder, array))
    report("16x16: multitouch after one load cell under the pad (1000 presses)", evaluate(model, multitouch))


def load_cell_recording(folder, array):
    """A multitouch scene of which only the total force is known, then unloaded frames."""
    presses = folder / "presses"
    dermis("simulate", "--array", array, "--scene", "multitouch", "--seed", 10, "--out", presses)
    idle = simulate(folder, array, "idle", 9)
    total = defaultdict(float)
    for load in csv.DictReader((presses / "loads.csv").open()):
        total[int(load["frame"])] += float(load["value"])
    frames = (presses / "frames.csv").read_text().splitlines()
    last = float(frames[-1].split(",")[0])
    unloaded = (idle / "frames.csv").read_text().splitlines()[1:101]
    frames += [f"{last + 1 + k}," + line.split(",", 1)[1] for k, line in enumerate(unloaded)]
    recording = folder / "load_cell"
    recording.mkdir(exist_ok=True)
    (recording / "frames.csv").write_text("\n".join(frames) + "\n")
    lines = [f"{frame},force,all,{newtons}" for frame, newtons in sorted(total.items())]
    lines += [f"{len(total) + k},force,all,0" for k in range(len(unloaded))]
    (recording / "loads.csv").write_text("frame,kind,where,value\n" + "\n".join(lines) + "\n")
    return recording


def memory_of_the_material(folder):
    array = array_toml(folder, (16, 16))
    physics = folder / "physics.toml"
    physics.write_text("[rubber]\npink_noise = 1e-6\n")
    model, _ = calibrate(folder, array, simulate(folder, array, "calibration", 1, physics))
    report("16x16 with pink noise of 0.3 %", evaluate(model, simulate(folder, array, "multitouch", 2, physics)))
    physics.write_text("[rubber]\nhysteresis = 0.10\ncreep = 0.05\npink_noise = 1e-6\n")
    model, _ = calibrate(folder, array, simulate(folder, array, "calibration", 1, physics))
    multitouch = simulate(folder, array, "multitouch", 2, physics)
    report("16x16 with 10 % hysteresis, 5 % creep and pink noise, calibrated from rest", evaluate(model, multitouch))
    model, _ = calibrate(folder, array, touches_up_and_down(folder, array, physics))
    report("16x16 with the same, calibrated on 600 frames of touches that rise and fall", evaluate(model, multitouch))


def touches_up_and_down(folder, array, physics):
    """A multitouch scene of which every taxel's force is known, then unloaded frames."""
    recording = folder / "touches"
    dermis(
        "simulate",
        "--array",
        array,
        "--scene",
        "multitouch",
        "--frames",
        600,
        "--seed",
        11,
        "--physics",
        physics,
        "--out",
        recording,
    )
    idle = simulate(folder, array, "idle", 9, physics)
    frames = (recording / "frames.csv").read_text().splitlines()
    last = float(frames[-1].split(",")[0])
    unloaded = (idle / "frames.csv").read_text().splitlines()[1::10]
    labels = [f"{len(frames) - 1 + k},force,all,0" for k in range(len(unloaded))]
    frames += [f"{last + 1 + k}," + line.split(",", 1)[1] for k, line in enumerate(unloaded)]
    (recording / "frames.csv").write_text("\n".join(frames) + "\n")
    loads = (recording / "loads.csv").read_text()
    (recording / "loads.csv").write_text(loads + "\n".join(labels) + "\n")
    return recording


def true_law(folder):
    """The error with the true law of the material behind the same inversion, from the test that holds it."""
    result = folder / "test.json"
    subprocess.run(
        [
            ROOT / "build/release/tests/calibration_test",
            f"--gtest_output=json:{result}",
            "--gtest_filter=Calibrate.reaches_the_noise_floor*",
        ],
        check=True,
        capture_output=True,
    )
    test = json.loads(result.read_text())["testsuites"][0]["testsuite"][0]
    shares = [100 * float(test[f"true_law_{key}"]) for key in ("median", "p95", "p99")]
    work = "16x16, 20 ohm / 200 ohm: multitouch after single presses"
    print(
        f"\n{work}, with the true law of the material\n  median {shares[0]:.2f} %, p95 {shares[1]:.2f} %, "
        f"p99 {shares[2]:.2f} %"
    )
    row(work, "true law", shares[0], "% median error", p95=shares[1], p99=shares[2])


def mean_of_last_five_seconds(path):
    frames = [[float(cell) for cell in line] for line in list(csv.reader(path.open()))[1:]]
    window = [frame for frame in frames if frame[0] >= frames[-1][0] - 5]
    return [sum(column) / len(window) for column in zip(*window)]


def real_weights(folder):
    """Leave one press out on the real hand: trained on the other 53, with one unloaded frame."""
    index = [press for press in csv.DictReader((DSA / "presses.csv").open()) if press["outlier"] == "0"]
    presses = [
        (mean_of_last_five_seconds(DSA / "presses" / f"{press['press']}.csv"), float(press["weight_g"]) * 9.80665e-3)
        for press in index
    ]
    header = (DSA / "presses" / f"{index[0]['press']}.csv").read_text().split("\n", 1)[0]
    array = folder / "dsa.toml"
    array.write_text('[array]\nrows = 13\ncols = 6\n[readout]\ncircuit = "none"\nadc_bits = 12\n')
    errors = defaultdict(list)
    scores = []
    for held_out, (frame, newtons) in enumerate(presses):
        training = [press for k, press in enumerate(presses) if k != held_out]
        unloaded = [0.0, training[0][0][1]] + [0.0] * 78
        write_recording(folder / "dsa", header, [(unloaded, 0.0)] + training)
        model, _ = calibrate(folder, array, folder / "dsa")
        write_recording(folder / "held_out", header, [(frame, newtons)])
        for result in evaluate(model, folder / "held_out")["estimators"]:
            errors[result["name"]].append(result["total_rmse_n"] * KPA_PER_NEWTON)
        scores.append(errors["dermis"][-1] / KPA_PER_NEWTON / total_sigma(folder, model))
    print("\nreal hand (dsa_weights), total force of the press left out\n  estimator             RMSE kPa")
    for name, of_name in errors.items():
        rmse = math.sqrt(sum(error**2 for error in of_name) / len(of_name))
        print(f"  {name:20}{rmse:10.2f}")
        row("dsa_weights, leave one press out", name, rmse, "kPa RMSE")
    for share, sigmas in ((68, 0.9945), (95, 1.96)):
        covered = 100 * sum(score <= sigmas for score in scores) / len(scores)
        print(f"  {share} % interval of the total covers {covered:.0f} % of {len(scores)} presses")
        row(f"dsa_weights, leave one press out: {share} % interval", "dermis", covered, "% covered")


def total_sigma(folder, model):
    """Standard deviation of the total force of the one frame of held_out, were the errors of taxels independent."""
    dermis(
        "run",
        "--model",
        model,
        "--in",
        folder / "held_out/frames.csv",
        "--out",
        folder / "forces.csv",
        "--sigma",
        folder / "sigma.csv",
    )
    forces, sigmas = (
        [float(cell) for cell in list(csv.reader((folder / name).open()))[1][2:]]
        for name in ("forces.csv", "sigma.csv")
    )
    return math.sqrt(sum(sigma**2 for newtons, sigma in zip(forces, sigmas) if newtons > 0 and math.isfinite(sigma)))


def write_recording(folder, header, labelled):
    folder.mkdir(exist_ok=True)
    frames = [",".join([str(k)] + [f"{value:.6g}" for value in frame[1:]]) for k, (frame, _) in enumerate(labelled)]
    loads = [f"{k},force,all,{newtons:.6f}" for k, (_, newtons) in enumerate(labelled)]
    (folder / "frames.csv").write_text("\n".join([header, *frames]) + "\n")
    (folder / "loads.csv").write_text("\n".join(["frame,kind,where,value", *loads]) + "\n")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        single_presses(folder)
        true_law(folder)
        other_calibrations(folder)
        memory_of_the_material(folder)
        if DSA.exists():
            real_weights(folder)
        else:
            print(f"\n{DSA} is not here: no real weights")
    target = ROOT / "build/release/bench/accuracy.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(rows, indent=2) + "\n")
    print(f"\nwritten: {target.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
