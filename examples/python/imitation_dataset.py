# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""A session as a dataset for imitation learning: forces and contacts beside the robot's joint angles, frame by frame.

    imitation_dataset.py session.mcap chest.safetensors joints.csv session.npz     (or session.h5, with h5py)

joints.csv: time_s, then one column a joint. Each frame gets the angles between the two lines around it.
"""

import argparse
import csv
import os
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

import dermis

CONTACTS = 4  # a frame; the strongest
CONTACT = np.dtype([("id", "u4"), ("x_m", "f4"), ("y_m", "f4"), ("force_n", "f4"), ("sigma_force_n", "f4")])


def joint_angles(path: str, time_s: NDArray[np.float64]) -> tuple[list[str], NDArray[np.float32]]:
    with open(path) as file:
        header, *lines = list(csv.reader(file))
    table = np.array(lines, dtype=np.float64)
    angles = [np.interp(time_s, table[:, 0], table[:, joint]) for joint in range(1, table.shape[1])]
    return header[1:], np.array(angles, dtype=np.float32).T


def contacts_of(force: dermis.ForceFrame, tracker: dermis.ContactTracker) -> NDArray[Any]:
    strongest = sorted(tracker.process(force), key=lambda contact: -contact.force_n)[:CONTACTS]
    row = np.zeros(CONTACTS, CONTACT)
    for k, contact in enumerate(strongest):
        row[k] = (contact.id, *contact.position_m, contact.force_n, contact.sigma_force_n)
    return row


def make_dataset(session: str, model_path: str, joints: str) -> dict[str, NDArray[Any]]:
    model, recording = dermis.read_model(model_path), dermis.Recording.read(session)
    pipeline, tracker = dermis.Pipeline(model), dermis.ContactTracker(model)
    forces = [pipeline.process(recording[k]) for k in range(len(recording))]
    names, angles = joint_angles(joints, recording.time_ns * 1e-9)
    return {
        "time_ns": recording.time_ns,
        "counts": recording.counts,
        "newtons": np.array([force.newtons for force in forces]),
        "sigma_newtons": np.array([force.sigma_newtons for force in forces]),
        "contacts": np.array([contacts_of(force, tracker) for force in forces]),
        "joint_names": np.array(names, dtype="S"),
        "joint_angles": angles,
    }


def main(session: str, model_path: str, joints: str, out: str) -> None:
    if os.path.exists(out):
        sys.exit(f"{out} exists; name another")
    dataset = make_dataset(session, model_path, joints)
    if out.endswith(".npz"):
        np.savez_compressed(out, **dataset)
    else:
        import h5py

        with h5py.File(out, "w") as file:
            for name, values in dataset.items():
                file.create_dataset(name, data=values, compression="gzip")
    print(f"{out}: {len(dataset['time_ns'])} frames, {dataset['joint_angles'].shape[1]} joints")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("session", help="recording of counts")
    parser.add_argument("model", help="model file of dermis calibrate")
    parser.add_argument("joints", help="CSV of joint angles")
    parser.add_argument("out", help=".npz or .h5 to write")
    options = parser.parse_args()
    main(options.session, options.model, options.joints, options.out)
