# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Threats, recognition and suits give what the commands give."""

import csv
import io
import json
import subprocess
import time

import workspace

import dermis

THREATS = """[[threat]]
name = "heavy"
quantity = "total_force"
limit_n = 60

[[threat]]
name = "corner"
quantity = "taxel_force"
limit_n = 2
latched = true
zone = "edge"

[[zone]]
name = "edge"
array = "pad"
rows = [0, 0]
cols = [0, 3]
"""


class Judging(workspace.CalibratedArray):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.loaded = dermis.read_model(cls.model)
        cls.recording = dermis.Recording.read(cls.frames)

    def forces(self):
        pipeline = dermis.Pipeline(self.loaded)
        return [pipeline.process(self.recording[k]) for k in range(len(self.recording))]

    def threats(self):
        path = self.folder / "threats.toml"
        path.write_text(THREATS)
        return path

    def test_threats_are_those_of_dermis_watch(self):
        watch = subprocess.run(
            [
                workspace.DERMIS,
                "watch",
                "--threats",
                self.threats(),
                "--model",
                self.model,
                "--in",
                self.frames,
                "--json",
            ],
            capture_output=True,
            text=True,
        )
        expected = [
            (line["event"], line["threat"], line["quantity"])
            for line in map(json.loads, watch.stdout.splitlines())
            if "threat" in line
        ]
        monitor = dermis.ThreatMonitor(self.threats(), self.loaded)
        found = [
            ("begins" if threat.stands else "ends", threat.name, threat.quantity)
            for force in self.forces()
            for threat in monitor.process(force)
        ]
        self.assertEqual(found, expected)
        self.assertIn(("ends", "heavy", "total_force"), found)

    def test_a_threat_says_what_stands_where(self):
        monitor = dermis.ThreatMonitor(self.threats(), self.loaded)
        began = [threat for force in self.forces() for threat in monitor.process(force) if threat.stands]
        corner = next(threat for threat in began if threat.name == "corner")
        self.assertGreater(corner.value - 2 * corner.sigma, corner.limit)
        self.assertEqual((corner.limit, corner.position_m[1]), (2.0, 0.0))
        self.assertRegex(repr(corner), r"^<dermis.Threat 'corner' stands: taxel force .* N, limit 2, at x .*>$")
        self.assertIn("corner", [threat.name for threat in monitor.standing])
        monitor.reset()
        self.assertNotIn("corner", [threat.name for threat in monitor.standing])

    def test_limits_that_do_not_fit_are_refused_in_a_line(self):
        self.threats().write_text(THREATS.replace("rows = [0, 0]", "rows = [0, 9]"))
        with self.assertRaisesRegex(dermis.BadInput, "edge"):
            dermis.ThreatMonitor(self.folder / "threats.toml", self.loaded)
        with self.assertRaisesRegex(ValueError, "another shape"):
            other = dermis.ArrayDescription.from_toml(
                '[array]\nrows = 1\ncols = 1\n[readout]\ncircuit = "force"\nadc_noise_counts = 0.1\n'
            )
            (self.folder / "one.toml").write_text(other.to_toml())
            force = dermis.Pipeline(dermis.read_model(self.folder / "one.toml")).process([[1.0]])
            dermis.ThreatMonitor(self.threats(), self.loaded).process(force)

    def test_what_is_recognised_is_what_dermis_recognise_says(self):
        pressed = {}
        with open(self.loads) as loads:
            for load in csv.DictReader(loads):
                pressed[int(load["frame"])] = pressed.get(int(load["frame"]), 0) + (float(load["value"]) > 0.3)
        kinds = {frame: "few" if count <= 3 else "many" for frame, count in pressed.items() if count}
        labels = self.folder / "labels.csv"
        labels.write_text("id,first,last,class\n" + "".join(f"{k},{k},{k},{kind}\n" for k, kind in kinds.items()))
        classes = self.folder / "classes.safetensors"
        workspace.dermis(
            "recognise", "learn", "--in", self.frames, "--model", self.model, "--labels", labels, "--out", classes
        )
        said = workspace.dermis("recognise", "--classes", classes, "--model", self.model, "--in", self.frames)
        recogniser = dermis.Recogniser(classes, self.loaded)
        self.assertEqual(recogniser.names, ["few", "many"])
        found = [recogniser.process(force) for force in self.forces()]
        lines = list(csv.DictReader(io.StringIO(said)))
        self.assertEqual(len(lines), len(found))
        for line, answer in zip(lines, found):
            self.assertEqual(
                (line["class"], line["likeliest"], line["reason"], int(line["last"])),
                (answer.name, answer.likeliest, answer.reason, answer.frames[1]),
            )
            self.assertAlmostEqual(float(line["probability"]), answer.probabilities[answer.likeliest], delta=1e-4)
        self.assertRegex(repr(found[0]), r"^<dermis.Recognition '\w+'.* in frames 0 to 0>$")
        with self.assertRaisesRegex(dermis.BadInput, "is not|holds no classes"):
            dermis.Recogniser(self.model, self.loaded)

    def test_all_arrays_of_a_suit_are_at_work(self):
        suit_toml = self.folder / "suit.toml"
        suit_toml.write_text(
            "".join(
                f'[[array]]\nname = "{name}"\nfrom = "sim:contacts?rate=100&seed={seed}"\nmodel = "pad.safetensors"\n'
                for name, seed in (("left", 1), ("right", 2))
            )
        )
        with dermis.Suit(suit_toml) as suit:
            self.assertEqual(
                ([array.name for array in suit], len(suit), repr(suit)),
                (["left", "right"], 2, "<dermis.Suit of left, right>"),
            )
            suit.tare(force=True)
            self.assertTrue(suit["left"].pipeline.taring)
            forces = suit.latest(5.0)
            self.assertEqual(
                {name: force.newtons.shape for name, force in forces.items()}, {"left": (5, 4), "right": (5, 4)}
            )
            contacts = suit["right"].contacts.process(forces["right"])
            self.assertIsInstance(contacts, list)
        with self.assertRaisesRegex(ValueError, "closed"):
            suit.latest()
        recording = self.folder / "suit.mcap"
        with dermis.serve(suit=suit_toml, record=recording, port=0):
            time.sleep(0.5)
        with dermis.Suit(suit_toml, recording) as played:
            frames = 0
            while played.latest():
                frames += 1
        self.assertGreaterEqual(frames, len(dermis.Recording.read(f"{recording}#left")))
        with self.assertRaisesRegex(dermis.BadInput, "nothing.mcap"):
            dermis.Suit(suit_toml, self.folder / "nothing.mcap")


if __name__ == "__main__":
    workspace.main()
