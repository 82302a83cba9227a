# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""No command writes onto a file that it reads, by any name of it, and none overwrites what cannot be made again."""

import fcntl
import itertools
import os
import re
import subprocess
from pathlib import Path

import support
from support import SmallArray, dermis

# What each command reads and writes: options, or arguments by their place.
COMMANDS = {
    "calibrate": (("--array", "--frames", "--loads"), ("--out",)),
    "circuit forward": (("--array", "--conductance"), ("--out",)),
    "circuit invert": (("--array", "--readings"), ("--out", "--sigma")),
    "convert": (("in", "--array"), ("out",)),
    "describe": (("source",), ("--out",)),
    "image": (("--in", "--model"), ("--out",)),
    "recognise learn": (
        ("--labels", "--in", "--model", "--splits", "--open"),
        ("--out", "--predictions", "--open-predictions"),
    ),
    "paper calibrate": (("--array", "--frames", "--loads"), ("--bank", "--checkpoint")),
    "doctor recalibrate": (("--model", "--frames", "--loads"), ("--out",)),
    "recognise": (("--classes", "--in", "--model", "--extra"), ("--out",)),
    "record": (("--from", "--array", "--model"), ("--out",)),
    "info recover": (("in",), ("--out",)),
    "replay": (("recording", "--model"), ("--out",)),
    "run": (("--model", "--in"), ("--out", "--sigma", "--totals", "--contacts")),
}
# And what is written into a folder.
FOLDERS = {
    "simulate": (("--array", "--physics"), "--out", ("frames.csv", "loads.csv", "contacts.csv", "origin.toml")),
    "evaluate": (("--model", "--frames", "--loads", "--classes", "--in", "--labels"), "--report", ("index.html",)),
    "paper evaluate": (("--model", "--frames", "--loads", "--bank"), "--report", ("index.html",)),
    "recognise learn": (("--labels", "--in", "--model", "--splits", "--open"), "--report", ("index.html",)),
}
MODELS = {
    ("calibrate", "--out"),
    ("recognise learn", "--out"),
    ("paper calibrate", "--bank"),
    ("doctor recalibrate", "--out"),
}
MODELS |= {("paper calibrate", "--checkpoint")}  # which is gone on from, or refused
PROTECTED = {
    "a recording": b"\x89MCAP0\r\n",
    "a model": b"\x10\0\0\0\0\0\0\0{}              ",
    "a description": b"[array]\nrows = 4\n",
    "frames": b"time_s,r0c0,r0c1\n0,1,2\n",
    "loads": b"frame,kind,where,value\n",
    "an array of NumPy": b"\x93NUMPY",
    "something else": b"notes\n",
}


def path_of(folder, option):
    return folder / option.strip("-")


def aliases(path, folder):
    """Other names of the same file, and its own."""
    link, hard_link = folder / "link", folder / "hard_link"
    link.symlink_to(path)
    os.link(path, hard_link)
    return {
        "itself": path,
        "a detour": path.parent / "." / ".." / path.parent.name / path.name,
        "a link": link,
        "a hard link": hard_link,
    }


class NothingIsOverwritten(SmallArray):
    def command(self, command, paths, *more):
        inputs, outputs = COMMANDS[command]
        words = [*command.split(), *more]
        for option in inputs + outputs:
            path = paths.get(option, self.work / ("new_" + option.strip("-")))
            words += [option, path] if option.startswith("--") else [path]
        return dermis(*words)

    def inputs(self, command):
        paths = {}
        for option in COMMANDS[command][0]:
            paths[option] = path_of(self.work, option)
            paths[option].write_bytes(b"valuable " + option.encode())
        return paths

    def test_every_command_that_writes_is_named_here(self):
        commands = re.findall(r"^  (\w+) {2,}", dermis("--help").stdout.split("Begin:")[1], re.MULTILINE)
        names = [
            *(set(commands) - {"circuit"}),
            "circuit forward",
            "circuit invert",
            "doctor check",
            "doctor recalibrate",
            "info recover",
            "recognise learn",
            "paper calibrate",
            "paper evaluate",
        ]
        writing = {name for name in names if "--force" in dermis(*name.split(), "--help").stdout}
        self.assertEqual(writing, {*COMMANDS, *FOLDERS, "paper"})

    def test_an_output_is_no_input(self):
        for command, (inputs, outputs) in COMMANDS.items():
            for read in inputs:
                for written in outputs:
                    paths = self.inputs(command)
                    for name, alias in aliases(paths[read], self.work).items():
                        with self.subTest(command=command, read=read, written=written, name=name):
                            result = self.command(command, {**paths, written: alias}, "--force")
                            self.assertEqual(result.returncode, 2, result)
                            self.assertEqual(result.stderr, f"dermis: {written}: is the file of {read}; name another\n")
                            self.assertEqual(paths[read].read_bytes(), b"valuable " + read.encode())
                    for path in self.work.iterdir():
                        path.unlink()

    def test_a_folder_is_not_written_over_an_input(self):
        required = {
            "simulate": {"--array": self.array, "--scene": "idle"},
            "evaluate": {},
            "paper evaluate": {"--bank": self.array},
            "recognise learn": {"--labels": self.array},
        }
        folder, link = self.work / "folder", self.work / "link"
        folder.mkdir()
        for command, (inputs, option, files) in FOLDERS.items():
            for read, file in itertools.product(inputs, files):
                path = folder / file
                path.write_text("valuable")
                link.symlink_to(path)
                for named in (path, link):
                    with self.subTest(command=command, read=read, file=file, named=named):
                        options = {**required[command], read: named, option: folder}
                        result = dermis(*command.split(), *itertools.chain(*options.items()), "--force")
                        self.assertEqual(
                            (result.returncode, result.stderr),
                            (2, f"dermis: {option}: is the file of {read}; name another\n"),
                        )
                        self.assertEqual(path.read_text(), "valuable")
                link.unlink()
                path.unlink()

    def test_no_command_writes_onto_what_its_suit_names(self):
        named = {
            "model": "m.safetensors",
            "classes": "c.safetensors",
            "body": "body.urdf",
            "positions": "places.csv",
            "a source": "frames.csv",
        }
        for name in named.values():
            self.written(name, "valuable")
        self.written("places.csv", "x_mm,y_mm,z_mm\n" + "0,0,0\n" * 20)
        suit = self.written(
            "suit.toml",
            '[suit]\nbody = "body.urdf"\nclasses = "c.safetensors"\n[[array]]\nname = "a"\n'
            f'from = "file:{self.work}/frames.csv?rate=100"\nmodel = "m.safetensors"\n'
            'positions_mm = "places.csv"\n',
        )
        for command in (
            ("recognise", "--classes", self.model, "--in", self.contacts / "frames.csv"),
            ("recognise", "learn", "--labels", self.contacts / "loads.csv", "--in", self.contacts / "frames.csv"),
        ):
            for what, name in named.items():
                with self.subTest(command[0], what=what):
                    before = (self.work / name).read_bytes()
                    result = dermis(*command, "--model", suit, "--out", self.work / "." / name, "--force")
                    self.assertEqual(
                        (result.returncode, result.stderr), (2, "dermis: --out: is the file of --model; name another\n")
                    )
                    self.assertEqual((self.work / name).read_bytes(), before)

    def test_a_page_in_the_folder_where_one_works_is_nobodys_report(self):
        self.written("index.html", "notes")
        result = dermis(*self.evaluate_arguments(), cwd=self.work)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual((self.work / "index.html").read_text(), "notes")

    def test_an_output_is_no_source_that_reads_a_file(self):
        frames = self.written("frames.csv", (self.contacts / "frames.csv").read_text())
        before = frames.read_bytes()
        for source in (f"file:{frames}?rate=100", f"{frames}#small"):
            result = dermis(*self.run_arguments(frames, **{"in": source}), "--force")
            self.assertEqual(
                (result.returncode, result.stderr), (2, "dermis: --out: is the file of --in; name another\n")
            )
            self.assertEqual(frames.read_bytes(), before)

    def test_an_output_is_no_file_that_a_source_names(self):
        layout = self.written("lay.toml", '[layout]\nname = "x"\n[[layout.array]]\nrows = 1\ncols = 2\n')
        self.written("x.txt", "1,2\n" * 50)
        sources = {
            layout: f"file:{self.work}/x.txt?layout={layout}",
            self.written("small.toml", support.ARRAY): f"sim:idle?frames=5&array={self.work}/small.toml",
            self.written("hand.toml", "[can]\n"): f"candump:{self.work}/x.txt?map={self.work}/hand.toml",
        }
        recording = self.work / "new.mcap"
        for named, source in sources.items():
            before = named.read_bytes()
            for name, alias in aliases(named, self.work).items():
                for written, command in (
                    ("--out", ("record", "--from", source, "--out", alias)),
                    ("--out", ("run", "--model", self.model, "--in", source, "--out", alias)),
                    ("--contacts", ("run", "--model", self.model, "--in", source, "--contacts", alias)),
                    ("--totals", ("run", "--model", self.model, "--in", source, "--totals", alias)),
                    ("--out", ("recognise", "--classes", self.model, "--in", source, "--out", alias)),
                    ("--out", ("replay", source, "--out", alias)),
                    ("--out", ("describe", source, "--out", alias)),
                    ("--out", ("image", "--in", source, "--out", alias)),
                    ("out", ("convert", source, alias)),
                ):
                    with self.subTest(command[0], source=source, name=name):
                        result = dermis(*command, "--force")
                        self.assertEqual(result.returncode, 2, result)
                        self.assertRegex(result.stderr, rf"^dermis: {written}: is the file of .*; name another\n$")
                        self.assertEqual(named.read_bytes(), before)
            for name in ("link", "hard_link"):
                (self.work / name).unlink()
        self.assertFalse(recording.exists())

    def test_an_output_is_no_file_that_is_found_in_a_folder(self):
        bag = self.work / "bag"
        bag.mkdir()
        part = bag / "bag_0.mcap"
        self.succeed("convert", self.contacts / "frames.csv", part)
        (bag / "metadata.yaml").write_text(
            "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
            "  relative_file_paths:\n    - bag_0.mcap\n"
        )
        before = part.read_bytes()
        for alias in aliases(part, self.work).values():
            for command in (("convert", bag, alias), ("replay", bag, "--speed", 0, "--out", alias)):
                result = dermis(*command, "--force")
                self.assertEqual(result.returncode, 2, result)
                self.assertRegex(result.stderr, r"^dermis: .*(is the file of .*; name another|name another output)\n$")
                self.assertEqual(part.read_bytes(), before)

    def test_an_output_that_another_writes_is_refused(self):
        files = {
            "calibrate": self.calibrate_arguments("")[1:-2],
            "doctor recalibrate": (
                "--model", self.model, "--frames", self.calibration / "frames.csv",
                "--loads", self.calibration / "loads.csv",
            ),
            "recognise learn": ("--labels", self.contacts / "loads.csv", "--in", self.contacts / "frames.csv"),
            "paper calibrate": self.calibrate_arguments("")[1:-2],
        }  # fmt: skip
        for command, (_, outputs) in COMMANDS.items():
            for written in outputs:
                path = self.work / f"there_{written.strip('-')}.csv"
                path.write_text("time_s,status,\n")
                with self.subTest(command=command, written=written), open(f"{path}.dermis.tmp", "wb") as held:
                    fcntl.flock(held, fcntl.LOCK_EX)
                    paths = {**self.inputs(command), written: path}
                    if command in files:
                        required = {"paper calibrate": ("--bank", path if written == "--bank" else self.work / "bank")}
                        more = required.get(command, ()) if written != "--bank" else ()
                        arguments = (*command.split(), *files[command], *more, written, path)
                        for one in ("--predictions", "--open-predictions"):
                            if written == one:
                                arguments += ("--splits" if one == "--predictions" else "--open", self.work / "splits")
                        result = dermis(*arguments, "--force")
                    else:
                        result = self.command(command, paths, "--force")
                    self.assertEqual(
                        (result.returncode, result.stderr.splitlines()[-1]),
                        (2, f"dermis: '{path}' is being written by another; wait for its end, or name another file"),
                    )
                    self.assertEqual(path.read_text(), "time_s,status,\n")
                for file in self.work.iterdir():
                    file.unlink()

    def test_a_file_that_appears_meanwhile_stays(self):
        frames = (self.contacts / "frames.csv").read_text()
        for name, command in (
            ("rec.csv", lambda pipe, out: ("record", "--from", pipe, "--out", out)),
            ("rec.npy", lambda pipe, out: ("record", "--from", pipe, "--out", out)),
            ("rec.h5", lambda pipe, out: ("record", "--from", pipe, "--out", out)),
            ("rec.mcap", lambda pipe, out: ("record", "--from", pipe, "--out", out)),
            ("out.h5", lambda pipe, out: ("convert", pipe, out)),
            ("out.csv", lambda pipe, out: self.run_arguments(out, **{"in": pipe})),
            ("again.csv", lambda pipe, out: ("replay", pipe, "--speed", 0, "--out", out)),
        ):
            for force in ((), ("--force",)):
                with self.subTest(name, force=force):
                    folder = self.work / (name + "".join(force))
                    folder.mkdir()
                    pipe, out = folder / "pipe.csv", folder / name
                    os.mkfifo(pipe)
                    process = subprocess.Popen(
                        [support.BINARY, *map(str, command(pipe, out)), *force], stderr=subprocess.PIPE, text=True
                    )
                    with pipe.open("w") as feed:
                        out.write_text("notes")
                        feed.write(frames)
                    said = process.communicate(timeout=60)[1].splitlines()[-1]
                    self.assertEqual(process.returncode, 1, said)
                    self.assertEqual(out.read_text(), "notes")
                    found = re.fullmatch(
                        rf"dermis: '{out}' is another's by now, and stays; what was written is '([^']+)'(; .*)?", said
                    )
                    self.assertTrue(found, said)
                    self.assertGreater(Path(found.group(1)).stat().st_size, 100)
                    self.assertEqual(list(folder.glob("*.dermis.tmp")), [])

    def test_names_that_no_file_can_have_are_told(self):
        long = self.work / ("a" * 300)
        for arguments in (
            ("simulate", "--array", self.array, "--scene", "idle", "--frames", 3, "--out", long),
            ("record", "--from", "sim:idle?rate=100&frames=3", "--out", f"{long}.mcap"),
            ("convert", f"{long}.csv", f"{long}.mcap"),
        ):
            with self.subTest(arguments[0]):
                result = dermis(*arguments)
                self.assertIn(result.returncode, (1, 2))
                self.assertRegex(result.stderr, r"^dermis: .*a': File name too long|^dermis: .*File name too long\n$")

    def test_two_outputs_are_two_files(self):
        result = dermis(*self.run_arguments(self.work / "f.csv"), "--contacts", self.work / "." / "f.csv")
        self.assertEqual(
            (result.returncode, result.stderr), (2, "dermis: --contacts: is the file of --out; name another\n")
        )

    def test_what_cannot_be_made_again_stays(self):
        for command, (_, outputs) in COMMANDS.items():
            paths = self.inputs(command)
            for written in outputs:
                for name, content in PROTECTED.items():
                    if name == "a model" and (command, written) in MODELS:
                        continue  # test_an_earlier_model_stays
                    with self.subTest(command=command, written=written, name=name):
                        path = self.work / "there"
                        path.write_bytes(content)
                        result = self.command(command, {**paths, written: path})
                        self.assertEqual(result.returncode, 2, result)
                        self.assertEqual(
                            result.stderr,
                            f"dermis: {written}: '{path}' exists; name another, or replace it with --force\n",
                        )
                        self.assertEqual(path.read_bytes(), content)

    def test_force_replaces_it(self):
        frames, recording = self.contacts / "frames.csv", self.work / "session.mcap"
        self.succeed("convert", frames, recording)
        for command in (
            ("record", "--from", frames, "--out"),
            ("convert", frames),
            ("info", "recover", recording, "--out"),
            self.calibrate_arguments("")[:-1],
        ):
            with self.subTest(command[0]):
                path = self.work / "there.mcap"
                path.write_bytes(b"\x89MCAP0")
                self.assertEqual(dermis(*command, path).returncode, 2)
                result = dermis(*command, path, "--force")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn(f"'{path}' exists and will be replaced\n", result.stderr)
                self.assertGreater(path.stat().st_size, 100)

    def test_an_earlier_model_stays(self):
        model = self.work / "model.safetensors"
        self.succeed(*self.calibrate_arguments(model))
        earlier = model.read_bytes()
        frames = self.written("f.csv", (self.calibration / "frames.csv").read_text() + "\n")
        result = dermis(*self.calibrate_arguments(model, frames=frames))
        self.assertEqual(result.returncode, 0, result.stderr)
        kept = next(self.work.glob("model-before-*.safetensors"))
        self.assertIn(f"'{model}' as it was: '{kept}'\n", result.stderr)
        self.assertEqual(kept.read_bytes(), earlier)
        self.assertNotEqual(model.read_bytes(), earlier)

    def test_tables_and_pictures_are_replaced_and_it_says_so(self):
        forces, contacts, picture, drawing, film = (
            self.work / name for name in ("forces.csv", "contacts.csv", "map.png", "map.svg", "map.gif")
        )
        for arguments, paths in (
            ((*self.run_arguments(forces), "--contacts", contacts), (forces, contacts)),
            (("image", "--in", self.contacts / "frames.csv", "--out", picture), (picture,)),
            (("image", "--in", self.contacts / "frames.csv", "--out", drawing), (drawing,)),
            (("image", "--in", self.contacts / "frames.csv", "--from", 0, "--to", 1, "--out", film), (film,)),
        ):
            self.succeed(*arguments)
            result = dermis(*arguments)
            said = "".join(f"'{path}' exists and will be replaced\n" for path in paths)
            self.assertEqual((result.returncode, result.stderr[: len(said)]), (0, said))

    def test_a_report_is_replaced_and_a_page_of_something_else_is_not(self):
        report = self.work / "report"
        arguments = (*self.evaluate_arguments(), "--report", report)
        self.succeed(*arguments)
        result = dermis(*arguments)
        self.assertEqual(
            (result.returncode, result.stderr), (0, f"'{report}/index.html' exists and will be replaced\n")
        )
        (report / "index.html").write_text("notes")
        self.assertEqual(dermis(*arguments).returncode, 2)
        self.assertEqual((report / "index.html").read_text(), "notes")

    def test_a_simulation_can_be_made_again_but_not_over_frames_of_a_device(self):
        folder = self.work / "data"
        arguments = ("simulate", "--array", self.array, "--scene", "idle", "--frames", 3, "--out", folder)
        self.succeed(*arguments)
        self.succeed(*arguments)
        (folder / "origin.toml").unlink()
        result = dermis(*arguments)
        self.assertEqual(result.returncode, 2)
        self.assertIn("/frames.csv' exists; name another, or replace it with --force", result.stderr)
        self.assertEqual(dermis(*arguments, "--force").returncode, 0)


if __name__ == "__main__":
    support.main()
