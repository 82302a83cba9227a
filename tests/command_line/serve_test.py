# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""dermis serve from outside: what it refuses, its page and documents, its recording. The stream itself:
tests/out/websocket."""

import gzip
import json
import re
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request

import support
from learn_test import npy
from support import SmallArray, dermis

PATIENCE = 120  # [s]
LIVE = "sim:contacts?rows=4&cols=5&rate=100"
LIMITS = """[[zone]]
name = "edge"
array = "{array}"
rows = [0, {last_row}]
cols = [0, 4]

[[threat]]
name = "edge"
quantity = "taxel_force"
limit_n = 0.5
zone = "edge"
"""


class Serve(SmallArray):
    def serve(self, *options):
        """The running server, with the notices that it gives first, and its address."""
        process = subprocess.Popen(
            [support.BINARY, "serve", "--port", "0", *map(str, options)],
            cwd=self.work,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        process.notices = []
        for line in process.stderr:
            if found := re.search(r"serving (.*) at (http://\S+/)", line):
                return process, found[2]
            process.notices.append(line)
        return self.fail("".join(process.notices))

    def end(self, process):
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(PATIENCE), 0)

    def get(self, address):
        with urllib.request.urlopen(address, timeout=PATIENCE) as answer:
            body = answer.read()
            return gzip.decompress(body) if answer.headers["Content-Encoding"] == "gzip" else body

    def recorded_frames(self, recording):
        result = dermis("convert", recording, self.work / "recorded.csv", "--force")
        self.assertEqual(result.returncode, 0, result.stderr)
        return len((self.work / "recorded.csv").read_text().splitlines()) - 1

    def test_page_and_suit(self):
        process, address = self.serve("--from", LIVE, "--model", self.model)
        self.assertIn(b"<html", self.get(address).lower())
        suit = json.loads(self.get(address + "suit.json"))
        [array] = suit["arrays"]
        self.assertEqual((array["name"], array["rows"], array["cols"]), ("small", 4, 5))
        self.assertEqual(array["full_scale_counts"], 4095)
        self.assertAlmostEqual(array["full_scale_n"], 50.0, delta=0.01)
        self.assertEqual(len(array["positions"]), 20)
        self.assertEqual(array["positions"][6], [0.01, 0.01, 0.0])
        self.assertEqual(array["normals"][0], [0.0, 0.0, 1.0])
        self.end(process)

    def test_an_array_that_is_still_to_be_calibrated(self):
        process, address = self.serve("--from", LIVE, "--model", self.array)
        self.assertEqual(json.loads(self.get(address + "suit.json"))["arrays"][0]["full_scale_n"], 50.0)
        self.end(process)

    def test_a_host_in_capitals(self):
        process, address = self.serve("--from", LIVE, "--model", self.model, "--host", "LOCALHOST")
        self.assertIn(b"<html", self.get(address).lower())
        self.end(process)

    def test_token(self):
        process, address = self.serve("--from", LIVE, "--model", self.model, "--token", "secret-1")
        self.assertIn(b"<html", self.get(address).lower())
        with self.assertRaises(urllib.error.HTTPError) as refused:
            self.get(address + "suit.json")
        self.assertEqual(refused.exception.code, 401)
        refused.exception.close()
        self.assertIn("arrays", json.loads(self.get(address + "suit.json?token=secret-1")))
        self.end(process)

    def learned(self, rows, cols):
        """Classes of presses on the upper and on the lower half of an array of that size."""
        folder = self.work / f"{rows}x{cols}"
        folder.mkdir()
        places = [(k % rows, k % cols) for k in range(24)]
        npy(
            folder / "frames.npy",
            [
                [5.0 + k / 10 if (i // cols, i % cols) == place else 0.0 for i in range(rows * cols)]
                for k, place in enumerate(places)
            ],
        )
        (folder / "arrays.csv").write_text(f"array,rows,cols,first_column\nskin,{rows},{cols},0\n")
        halves = ("upper" if row < rows / 2 else "lower" for row, _ in places)
        (folder / "labels.csv").write_text(
            "id,first,last,class\n" + "".join(f"t{k},{k},{k},{half}\n" for k, half in enumerate(halves))
        )
        result = dermis(
            "recognise",
            "learn",
            "--frames",
            folder / "frames.npy",
            "--arrays",
            folder / "arrays.csv",
            "--labels",
            folder / "labels.csv",
            "--out",
            folder / "classes.safetensors",
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        return folder / "classes.safetensors"

    def test_names_touches_and_watches_limits(self):
        threats = self.written("threats.toml", LIMITS.format(array="small", last_row=1))
        process, address = self.serve(
            "--from", LIVE, "--model", self.model, "--classes", self.learned(4, 5), "--threats", threats
        )
        self.assertEqual(["not learned with a model" in notice for notice in process.notices], [True])
        [array] = json.loads(self.get(address + "suit.json"))["arrays"]
        self.assertEqual(array["classes"], ["lower", "upper"])
        self.assertEqual([(limit["name"], limit["zone"]["rows"]) for limit in array["limits"]], [("edge", [0, 1])])
        self.assertIn("threat 'edge' on 'small': taxel force", process.stderr.readline())
        self.end(process)

    def test_classes_and_limits_that_do_not_fit(self):
        serve = ["serve", "--port", "0", "--from", LIVE, "--model", self.model]
        classes = self.learned(6, 5)
        self.refuse([*serve, "--classes", classes], ["classes.safetensors", "4x5", "6x5"])
        self.refuse([*serve, "--classes", self.work / "none.safetensors"], ["none.safetensors"])
        self.refuse(["serve", "--suit", "suit.toml", "--classes", classes], ["--classes", "suit.toml"])
        self.refuse([*serve, "--threats", self.work / "none.toml"], ["none.toml"])
        outside = self.written("threats.toml", LIMITS.format(array="small", last_row=9))
        self.refuse([*serve, "--threats", outside], ["threats.toml", "edge", "4 x 5"])

    def test_records_all_arrays_of_a_suit(self):
        suit = self.written(
            "suit.toml",
            "\n".join(
                f'[[array]]\nname = "{name}"\nfrom = "{LIVE}&seed={seed}"\nmodel = "{self.model}"\n'
                f"base_from_array = {{translation_mm = [{100 * seed}, 0, 0]}}\n"
                for seed, name in enumerate(("left", "right"))
            ),
        )
        recording = self.work / "suit.mcap"
        process, address = self.serve("--suit", suit, "--record", recording)
        arrays = json.loads(self.get(address + "suit.json"))["arrays"]
        self.assertEqual([array["name"] for array in arrays], ["left", "right"])
        self.assertEqual(arrays[1]["positions"][0], [0.1, 0.0, 0.0])
        time.sleep(1.0)
        self.end(process)
        for name in ("left", "right"):
            self.assertGreater(self.recorded_frames(f"{recording}#{name}"), 30)
        self.refuse(
            ["serve", "--from", recording],
            ["holds 2 arrays; name one, as", "'left', 'right'; or play all of it with --suit"],
        )
        self.refuse(
            ["serve", "--from", recording, "--model", self.model], ["has no array 'small'; it has: 'left', 'right'"]
        )

        process, address = self.serve("--from", recording, "--suit", suit)
        self.assertEqual(
            [array["name"] for array in json.loads(self.get(address + "suit.json"))["arrays"]], ["left", "right"]
        )
        self.end(process)
        process, address = self.serve("--from", f"{recording}#right", "--model", self.model)
        self.end(process)

    def test_a_recording_that_describes_its_array_needs_no_model(self):
        recording = self.work / "told.mcap"
        self.succeed("convert", self.contacts / "frames.csv", recording, "--array", self.array)
        process, address = self.serve("--from", recording)
        [array] = json.loads(self.get(address + "suit.json"))["arrays"]
        self.assertEqual((array["name"], array["rows"], array["cols"]), ("small", 4, 5))
        self.end(process)

    def test_the_simulator_needs_no_model(self):
        process, address = self.serve("--from", LIVE)
        [array] = json.loads(self.get(address + "suit.json"))["arrays"]
        self.assertEqual((array["rows"], array["cols"]), (4, 5))
        self.end(process)

    def test_the_array_of_any_other_recording_is_asked_for_as_that_of_a_device(self):
        recording = self.work / "untold.mcap"
        self.succeed("convert", self.contacts / "frames.csv", recording)
        process = subprocess.Popen(
            [support.BINARY, "serve", "--port", "0", "--from", recording],
            cwd=self.work,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        asked = re.search(r"describe the array at (http://\S+/)", process.stderr.readline())
        setup = json.loads(self.get(asked[1] + "suit.json"))["setup"]
        self.assertEqual((setup["from"], setup["rows"], setup["cols"]), (str(recording), 4, 5))

    def test_what_is_neither_device_nor_recording_is_refused_before_anybody_is_asked(self):
        for source, words in (
            (self.contacts / "frames.csv", "make a recording of it first"),
            ("sim:contacts", "say how many frames a second it sends"),
        ):
            self.refuse(("serve", "--port", 0, "--from", source), [f"'{source}': ", words])

    def test_a_recording_that_exists_stays(self):
        recording = self.work / "day.mcap"
        recording.write_bytes(b"an earlier session")
        process, _ = self.serve("--from", LIVE, "--model", self.model, "--record", recording)
        time.sleep(0.5)
        self.end(process)
        [fresh] = self.work.glob("day-*.mcap")
        self.assertIn(f"the recording is '{fresh}'\n", process.notices)
        self.assertEqual(recording.read_bytes(), b"an earlier session")
        self.assertGreater(self.recorded_frames(fresh), 10)

    def test_what_cannot_be_served(self):
        serve = ["serve", "--port", "0"]
        frames = self.contacts / "frames.csv"
        self.refuse([*serve, "--model", self.model], ["--from", "--model"])
        token = self.work / "token"
        token.touch(0o600)
        token.write_text("a-long-token")
        self.refuse([*serve, "--host", "0.0.0.0", "--token-file", token], ["host", "URI"])
        self.refuse([*serve, "--from", frames], ["make a recording of it first"])
        self.refuse([*serve, "--from", LIVE, "--model", self.work / "none.safetensors"], ["none.safetensors"])
        self.refuse([*serve, "--from", frames, "--model", self.model], ["frames.csv", "convert", "to .mcap"])
        self.refuse([*serve, "--from", "sim:contacts?rows=4&cols=5", "--model", self.model], ["rate=100"])
        for wrong in ("bogus=1", "rate=abc"):
            self.refuse([*serve, "--from", f"sim:contacts?{wrong}", "--model", self.model], [wrong.partition("=")[0]])
        self.refuse([*serve, "--from", LIVE, "--model", self.model, "--record", "r.csv"], ["--record", ".mcap"])
        self.refuse([*serve, "--from", LIVE, "--model", self.model, "--host", "0.0.0.0"], ["token"])
        self.refuse([*serve, "--suit", self.work / "none.toml"], ["none.toml"])

    def test_a_port_that_is_taken(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            self.refuse(["serve", "--from", LIVE, "--model", self.model, "--port", port], [str(port)], status=1)

    def test_a_recording_that_cannot_be_written(self):
        self.refuse(
            ["serve", "--port", "0", "--from", LIVE, "--model", self.model, "--record", "/nowhere/r.mcap"],
            ["/nowhere/r.mcap"],
            status=1,
        )


if __name__ == "__main__":
    support.main()
