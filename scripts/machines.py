# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Bare machines: Debians with little more than apt, each in a container of its own on this one's network.

They need root and the packages of "scripts/setup bare"."""

import contextlib
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
APT_ARCHIVES = CACHE / "dermis/apt_archives"
CCACHE = CACHE / "ccache"
CERTIFICATES = Path("/usr/local/share/ca-certificates")
HOST = "bare"
HOSTS = rf"127.0.0.1 localhost\n::1 localhost\n127.0.1.1 {HOST}\n"  # as Debian's installer writes them
WEEK_S = 7 * 24 * 3600


class Machine:
    """A Debian of its own on top of an image, or of another machine: what is written in it stays in its folder."""

    def __init__(self, folder, lower):
        self.folder = Path(tempfile.mkdtemp(dir=folder))
        upper, work, self.root = (self.folder / name for name in ("upper", "work", "root"))
        for path in (upper, work, self.root):
            path.mkdir()
        subprocess.run(
            ["mount", "-t", "overlay", "overlay", "-o", f"lowerdir={lower},upperdir={upper},workdir={work}", self.root],
            check=True,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", self.root], check=True)
        shutil.rmtree(self.folder)

    def path(self, place):
        return self.root / place.lstrip("/")

    def line(self, user, command, folder="/"):
        """The command line by which the user of that name runs a command of bash in it. ccache and the archives of apt
        are this machine's. Only root writes to ccache, since its files are root's."""
        reads_only = [] if user == "root" else ["--setenv=CCACHE_READONLY=1", "--setenv=CCACHE_TEMPDIR=/tmp"]
        return [
            "systemd-nspawn",
            "--quiet",
            "--register=no",
            "--keep-unit",
            "--console=pipe",
            "--suppress-sync=yes",
            f"--hostname={HOST}",
            "--resolv-conf=copy-host",
            f"--directory={self.root}",
            f"--user={user}",
            f"--chdir={folder}",
            f"--bind={APT_ARCHIVES}:/var/cache/apt/archives",
            f"--bind={CCACHE}:/borrowed/ccache",
            "--setenv=CCACHE_DIR=/borrowed/ccache",
            *reads_only,
            "/bin/bash",
            "-c",
            command,
        ]


def emulate(architecture):
    """Has the kernel run its programs by qemu, as systemd-binfmt does."""
    kernel = Path("/proc/sys/fs/binfmt_misc")
    if not (kernel / "register").exists():
        subprocess.run(["mount", "-t", "binfmt_misc", "binfmt_misc", kernel], check=True)
    name = f"qemu-{architecture}"
    if not (kernel / name).exists():
        (kernel / "register").write_text(Path(f"/usr/lib/binfmt.d/{name}.conf").read_text().strip())


def make_image(name, suite, packages, architecture=None):
    """The archive of what machines begin with, made anew when a week old, with this machine's settings of apt and its
    certificates."""
    image = CACHE / f"dermis/{name}.tar.zst"
    for folder in (CCACHE, APT_ARCHIVES / "partial"):
        folder.mkdir(parents=True, exist_ok=True)
    if image.exists() and time.time() - image.stat().st_mtime < WEEK_S:
        return image
    for archive in APT_ARCHIVES.glob("*.deb"):
        archive.unlink()
    with tempfile.TemporaryDirectory(dir=image.parent) as folder:
        settings = Path(folder) / "apt.conf"
        settings.write_bytes(subprocess.run(["apt-config", "dump", "Acquire"], check=True, capture_output=True).stdout)
        made = Path(folder) / image.name
        subprocess.run(
            [
                "mmdebstrap",
                "--quiet",
                "--variant=minbase",
                *(
                    [f"--architectures={architecture}", "--skip=check/qemu"] if architecture else []
                ),  # emulate() sees to it
                f"--include={','.join(packages)}",
                f"--aptopt={settings}",
                f"--customize-hook=copy-in {CERTIFICATES} {CERTIFICATES.parent}",
                '--customize-hook=[ ! -x "$1/usr/sbin/update-ca-certificates" ] || chroot "$1" update-ca-certificates',
                f'--customize-hook=printf "{HOSTS}" >"$1/etc/hosts"',
                suite,
                made,
                # Of other processors a mirror may lack what was mended last.
                *([f"deb http://deb.debian.org/debian {suite} main"] if architecture else []),
            ],
            check=True,
        )
        made.rename(image)
    return image


@contextlib.contextmanager
def unpacked(image):
    """A folder for machines, and the image in it. It is in memory: on a disk it takes as long to remove a machine as to
    fill it."""
    with tempfile.TemporaryDirectory(prefix="bare_machine_", dir="/var/tmp") as folder:
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=80%,mode=755", "tmpfs", folder], check=True)
        try:
            lower = Path(folder) / "image"
            lower.mkdir()
            subprocess.run(["tar", "--zstd", "-xpf", image, "-C", lower], check=True)
            yield Path(folder), lower
        finally:
            subprocess.run(["umount", folder], check=True)
