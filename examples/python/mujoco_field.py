#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Forces of MuJoCo as a field for `dermis simulate`: a ball and a box fall onto a sheet of 8x8 taxels.

mujoco_field.py forces.npy     (with mujoco, from PyPI)
dermis simulate --array array.toml --field forces.npy --out counts
"""

import argparse

import numpy as np

ROWS, COLS = 8, 8
FRAMES, RATE_HZ = 150, 100
# The grid looks up at the sheet (0.1 m wide) from 0.05 m below it, with an angle of 45 degrees to either side.
SCENE = f"""
<mujoco>
  <extension><plugin plugin="mujoco.sensor.touch_grid"/></extension>
  <option timestep="0.001"/>
  <worldbody>
    <body name="sheet">
      <geom type="box" size=".05 .05 .005" pos="0 0 -.005"/>
      <site name="below" pos="0 0 -.05" euler="180 0 0"/>
    </body>
    <body pos="-.03 -.02 .04"><freejoint/><geom type="sphere" size=".015" mass="0.3" solref="0.01 1"/></body>
    <body pos=".02 .02 .03"><freejoint/><geom type="box" size=".015 .01 .01" mass="0.8" solref="0.01 1"/></body>
  </worldbody>
  <sensor>
    <plugin name="touch" plugin="mujoco.sensor.touch_grid" objtype="site" objname="below">
      <config key="size" value="{COLS} {ROWS}"/>
      <config key="fov" value="45 45"/>
      <config key="gamma" value="0"/>
      <config key="nchannel" value="1"/>
    </plugin>
  </sensor>
</mujoco>
"""


def main(path: str) -> None:
    import mujoco

    model = mujoco.MjModel.from_xml_string(SCENE)
    data = mujoco.MjData(model)
    steps = round(1 / RATE_HZ / model.opt.timestep)
    forces = np.zeros((FRAMES, ROWS, COLS), np.float32)
    for frame in forces:
        mujoco.mj_step(model, data, nstep=steps)
        frame[:] = data.sensor("touch").data.reshape(ROWS, COLS)
    np.save(path, forces)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path")
    main(parser.parse_args().path)
