// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "command_texts.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace dermis::app {
namespace {

constexpr std::size_t kWidth = 100;

constexpr std::array kTexts{
    CommandText{"dermis serve",
                "It serves until Ctrl-C, to browsers and to Foxglove (docs/stream.md). Without a source the page asks "
                "where the array is, and calibrates it. One array has --from and --model; several have --suit "
                "(docs/suit.md). To calibrate in the browser, give array.toml as the model.",
                "dermis serve\n"
                "dermis serve --from 'serial:///dev/ttyACM0?protocol=flexitac' --model skin.safetensors\n"
                "dermis serve --suit suit.toml --record rec.mcap\n"
                "dermis serve --suit suit.toml --host 0.0.0.0 --token-file token.txt"},
    CommandText{"dermis describe",
                "It looks at bytes that dermis does not know, of a file or 3 s of a device. It proposes at most three "
                "layouts (docs/layouts.md), the best first. \"+\" speaks for one, \"-\" is left over, \"?\" may be "
                "otherwise. On a terminal it asks for what the bytes cannot tell. Where no layout reads two thirds of "
                "the bytes there is none, and the exit status is 2.",
                "dermis describe serial:///dev/ttyACM0 --out mat.toml"},
    CommandText{"dermis record",
                "One thread reads frames and another writes them, so none is lost. Ctrl-C ends it with a complete "
                "file. If the device fails, the frames before are complete in the file, and the status is 1. It is 2 "
                "if for 5 s bytes came that are no frames of the protocol. Until a table such as frames.csv is "
                "complete, frames.csv.mcap beside it keeps the frames.",
                "dermis record --from 'serial:///dev/ttyACM0?protocol=flexitac' --out rec.mcap\n"
                "dermis record --from 'sim:multitouch?rows=64&cols=160&rate=1000' --seconds 10 --out rec.mcap"},
    CommandText{"dermis simulate",
                "It writes raw counts, the true loads, and how they were made. docs/simulation.md says what is "
                "modelled. The same seed gives the same bytes. The scenes multitouch, calibration, uniform, paper, "
                "idle, touches, two_weights and contacts differ in who presses what.",
                "dermis simulate --array array.toml --scene calibration --out cal\n"
                "dermis simulate --array array.toml --scene multitouch --seed 2 --frames 500 --out contacts\n"
                "dermis simulate --array array.toml --scene two_weights --taxels 8 --memory rubber --out weights"},
    CommandText{"dermis calibrate",
                "It prints five lines: what was fitted, how far off it is on loads left out of the fit, what is in "
                "doubt, what to do next, and where the model lies. docs/calibration.md says which loads to press. "
                "Judge the model on a second recording with 'dermis evaluate'.",
                "dermis calibrate --array array.toml --frames cal/frames.csv --loads cal/loads.csv --out "
                "skin.safetensors"},
    CommandText{"dermis evaluate",
                "It judges a model on taxels whose true force is known, and at least a fiftieth of the heaviest "
                "calibrated load. Beside it stand look-up tables from the same calibration: raw_lookup of the "
                "reading, temperature_lookup with a linear term, crosstalk_lookup after the inversion. Ghost force is "
                "what unloaded taxels report. --leave-out press needs no model: it calibrates without each press in "
                "turn, and judges that one. --classes judges those of 'dermis recognise learn' instead of forces.",
                "dermis evaluate --model skin.safetensors --frames test.csv --loads test_loads.csv --report report\n"
                "dermis evaluate --leave-out press --array array.toml --frames cal.csv --loads cal_loads.csv\n"
                "dermis evaluate --classes classes.safetensors --model skin.safetensors --in friday.mcap --labels "
                "friday.csv"},
    CommandText{"dermis run",
                "Frames that cannot be used have the status rejected and no forces; a line at the end counts them. If "
                "most frames have no forces, or readings, temperatures or supplies cannot be right, the exit status "
                "is 1 and the last line names the mend. Name at least one of the four files to write. "
                "docs/units-and-shapes.md lists the statuses.",
                "dermis run --model skin.safetensors --in frames.csv --out forces.csv --contacts contacts.csv\n"
                "dermis run --model skin.safetensors --in rec.mcap --out - | less"},
    CommandText{"dermis top",
                "It shows the rate, losses, the total and each contact with its force and place. A recording plays at "
                "its own pace. With NO_COLOR letters stand for colours.",
                "dermis top --from 'sim:contacts?rate=200' --model skin.safetensors"},
    CommandText{"dermis watch", "It prints each threat, and can stop a program. docs/threats.md has the limits.",
                "dermis watch --threats threats.toml --model skin.safetensors --in serial:///dev/ttyACM0 -- python3 "
                "robot.py"},
    CommandText{"dermis recognise",
                "It prints a line for each gesture when it is over, and one for each frame of a pose "
                "(docs/recognition.md). The class is unknown where the unknown score is too high, and the reason "
                "stands behind it.",
                "dermis recognise --classes classes.safetensors --model skin.safetensors --in wednesday.mcap"},
    CommandText{"dermis recognise learn",
                "It prints how well the classes are told apart. A class needs two examples; its figures mean something "
                "from five on. Name at least one output. docs/recognition.md describes the files.",
                "dermis recognise learn --in monday.mcap tuesday.mcap --labels labels.csv --model skin.safetensors "
                "--out classes.safetensors"},
    CommandText{"dermis doctor",
                "It says in plain words how an array is: noise, saturation, drift, gains, temperature, frames that do "
                "not fit the circuit, and each fault of a line or taxel (docs/health.md). The exit status is 0 for a "
                "healthy array, else 1.",
                "dermis doctor --model skin.safetensors --in frames.csv"},
    CommandText{"dermis doctor check",
                "Put the object on, let go of it, wait five seconds, take it off; several times make the answer surer. "
                "It may stand on feet, as the sum of all contacts counts. The exit status is 3 if gains have changed, "
                "and 1 if nothing could be weighed.",
                "dermis doctor check --model skin.safetensors --in 'serial:///dev/ttyACM0?protocol=flexitac' --weight "
                "'500 g'"},
    CommandText{"dermis doctor recalibrate",
                "It prints by how much the gains have changed, and writes a model with the mended ones. At most 1000 "
                "presses. Frames in a row with one label are one press, until its reading falls below a third.",
                "dermis doctor recalibrate --model skin.safetensors --frames now.csv --loads weights.csv"},
    CommandText{"dermis info",
                "It tells frames, rate, losses and doubts of a recording, and array, circuit, calibration and "
                "uncertainty of a model. A recording answers from its index; other files are read to the end. If a "
                "file is cut off, the exit status is 1. Commands read one array of several as rec.mcap#chest.",
                "dermis info rec.mcap\ndermis info skin.safetensors"},
    CommandText{"dermis info recover",
                "It writes all that is whole as a complete recording with an index. A chunk whose checksum is wrong is "
                "dropped (docs/recordings.md). If nothing is left, it writes no file, and the status is 1.",
                "dermis info recover cut.mcap --out whole.mcap"},
    CommandText{"dermis replay", "Its forces are those of 'dermis run', bit for bit, at any speed.",
                "dermis replay rec.mcap --model skin.safetensors\n"
                "dermis replay rec.mcap#chest --model skin.safetensors --out forces.mcap"},
    CommandText{"dermis emulate",
                "By default it makes a pseudo-terminal, prints its name and waits until a program opens it. Where the "
                "host asks for each frame, it answers each request.",
                "dermis emulate --protocol dermis --in rec.mcap --to tcp-listen://127.0.0.1:7000"},
    CommandText{"dermis convert",
                "The endings of the names give the formats (docs/file-formats.md). A recording that was cut off is "
                "converted up to there, and the exit status is 1. Other topics of a recording are not converted.",
                "dermis convert rec.mcap rec.h5"},
    CommandText{"dermis image",
                "Each measured taxel is a square, r0c0 at the top left; nothing is interpolated, and a taxel without a "
                "value is crossed out. An ellipse has the area, direction and proportions of a contact. To compare "
                "pictures give all the same --high.",
                "dermis image --in rec.mcap --model skin.safetensors --at 3 --out touch.png\n"
                "dermis image --in rec.mcap --model skin.safetensors --from 2 --to 6 --high 5 --out touch.gif"},
    CommandText{"dermis dataset",
                "docs/datasets.md says what steps, columns and layouts are. Frames that are in no window are counted.",
                "dermis dataset rec.mcap --model skin.safetensors --out touch --fps 30 --window 5"},
    CommandText{"dermis fleet", "Robots publish with 'dermis serve --publish'; docs/fleet.md has the whole way."},
    CommandText{"dermis circuit",
                "It computes in double precision, without ADC, for people who design a circuit or judge other "
                "software. docs/circuits.md shows the circuits; the array needs one whose resistances are known."},
    CommandText{"dermis circuit forward",
                "Readings are over the supply, as the ADC sees them. With pressure_raises_reading = false they fall "
                "with conductance.",
                "dermis circuit forward --array array.toml --conductance siemens.csv --out readings.csv"},
    CommandText{"dermis circuit invert",
                "A reading below what its neighbours alone explain gives 0 S. A frame that no conductances explain is "
                "nan, and the exit status is 1. What 'forward' wrote is recovered to 1e-8 or better.",
                "dermis circuit invert --array array.toml --readings readings.csv --out back.csv --sigma sigma.csv"},
    CommandText{"dermis circuit advise",
                "It simulates contacts, inverts their readings for each load, and finds the load with the least "
                "relative 1-sigma. Loads from R_MIN/100 to 10 R_MAX are tried. Smaller drivers are always better: it "
                "says how large they may be before the mean grows by 10 %.",
                "dermis circuit advise --array array.toml --range 900 200000"},
    CommandText{"dermis paper",
                "It takes several minutes on two cores (docs/paper.md). Its commands judge the paper's networks beside "
                "dermis; none of them is needed to calibrate or to run an array.",
                "dermis paper --report paper"},
    CommandText{"dermis paper calibrate", "'mpirun -n K' splits the bank over processes (docs/network.md).",
                "dermis paper calibrate --array array.toml --frames frames.csv --loads loads.csv --bank "
                "bank.safetensors"},
};

constexpr std::string_view kGeneral = R"(## Exit status

Results go to stdout, progress and errors to stderr. An error is one line that names the file, the line and the remedy:

```
dermis: frames.csv:17: has 200 values, the header 258
```

| exit status | meaning |
|---|---|
| 0 | done |
| 1 | the work failed: a full disk, a folder that cannot be written; `doctor`: the array is not healthy; an input that is cut off, or of which more than half of the frames give no force: what could be read is used, and the last line says what is missing |
| 2 | bad usage or bad input: an unknown option, a file that is missing, wrong or without a frame, loads that do not fit the array |
| 3 | `watch`: a threat; `doctor check`: gains have changed |
| 141 | who read the standard output has ended, as `head` does |

## Standard input and output

`-` in place of a file is the standard input or output, for frames as frames.csv and for other tables. Models, classes,
recordings, pictures and folders are no streams: there `-` is refused. One option of a command may read the standard input.

```sh
zcat session.csv.gz | dermis run --model skin.safetensors --in - --out - | head -3
```

## Output files

An output file appears complete or not at all. An earlier file of the same name stays until then. What cannot be made
again is not overwritten:

| what is there | what happens |
|---|---|
| a file that the command reads, under any name of it, one that a source or its suit.toml names, or its other output | status 2, with `--force`, too |
| a file that another `dermis` writes, or another program has locked (`flock`) | status 2, with `--force`, too |
| a model or classes, where the command writes such | the earlier one stays as `skin-before-20261126-140300.safetensors` (UTC), and a line says so |
| a table of results, a picture or a report | it is replaced, and a line says so |
| files of a simulation, in a folder with its origin.toml | they are replaced by those of another |
| a recording of `serve --record` | the new one has the UTC time in its name, and a line names it |
| any other file: a recording, frames, a model, a description, a dataset, notes | status 2; `--force` replaces it |
| a file that appears while the command works | it stays; the output gets the UTC time in its name, and the status is 1 |

Until it is complete, `NAME` grows as the file or folder `NAME.dermis.tmp` beside it, locked by its process. If that is
killed, the next command that writes into the folder removes it. Until `dermis record` has completed a table such as
`frames.csv`, the recording `frames.csv.mcap` beside it holds the same frames. It stays where the process is killed:
`dermis convert frames.csv.mcap frames.csv` makes the table, says that it was cut off, and ends with 1. A new
recording to `frames.csv` is refused as long as it is there.

## Forces

A person may write a force in newtons, or with a unit: `2`, `2 N`, `1500 mN`, `200 g`, `0.2 kg`. A pressure is in kPa, or
`500 Pa`, `0.1 MPa`. A line says for how many newtons a value was taken.
)";

/// Breaks the sentences at spaces.
std::string wrapped(std::string_view text) {
  std::istringstream words{std::string(text)};
  std::string lines;
  std::size_t length = 0;
  for (std::string word; words >> word; length += word.size()) {
    const bool is_full = length + 1 + word.size() > kWidth;
    if (!lines.empty()) lines += is_full ? '\n' : ' ';
    length = is_full ? 0 : length + 1;
    lines += word;
  }
  return lines;
}

}  // namespace

CommandText command_text(std::string_view command) {
  const auto* const found =
      std::find_if(kTexts.begin(), kTexts.end(), [&](const CommandText& text) { return text.command == command; });
  return found == kTexts.end() ? CommandText{command, ""} : *found;
}

std::string help_text(const CommandText& text) {
  std::string lines = wrapped(text.about);
  if (text.examples.empty()) return lines;
  lines += "\n\nExamples:";
  std::istringstream examples{std::string(text.examples)};
  for (std::string example; std::getline(examples, example);) lines += "\n  " + example;
  return lines;
}

std::string_view general_text() {
  return kGeneral;
}

}  // namespace dermis::app
