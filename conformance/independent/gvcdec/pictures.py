# SPDX-License-Identifier: MIT
"""Pictures by the program ffmpeg (gvc.md 6.1, 6.2): exact, none dropped, none concealed."""

import shutil
import subprocess
import tempfile
import threading

import numpy as np

from .errors import Damaged, Limit, placed
from .slices import SKIPPED, nal_units

DELIMITER = b"\0\0\0\1\x09\xf0"  # an access unit begins here, whatever its slices are like
START = b"\0\0\0\1"
COMMAND = [
    "ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-xerror",
    # Reorder as far as the level allows, not as far as ffmpeg guesses.
    "-threads", "1", "-strict", "strict",
    "-err_detect", "crccheck+bitstream+buffer+explode",
    # Crop on the left exactly, too.
    "-flags", "+unaligned",
    "-f", "h264", "-i", "pipe:0",
    "-map", "0:v:0", "-fps_mode", "passthrough", "-f", "rawvideo", "pipe:1",
]


class Decoder:
    """One run of ffmpeg over a fragment, a stream by itself (6.2.8); read() gives the pictures."""

    def __init__(self, fragment, parameters):
        self.fragment, self.parameters = fragment, parameters
        self.errors = tempfile.TemporaryFile()
        self.process = subprocess.Popen(COMMAND, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.errors)
        self.feeder = threading.Thread(target=self._feed, daemon=True)
        self.feeder.start()

    def _feed(self):
        """Write parameter sets and samples as a byte stream (Annex B of H.264)."""
        p, out = self.parameters, self.process.stdin
        try:
            with out:
                out.write(START + p.sps + START + p.pps)
                for i in range(self.fragment.count):
                    units = nal_units(self.fragment.sample("geometry", i))
                    units = [u for u in units if u[0] & 31 not in SKIPPED]
                    out.write(DELIMITER + b"".join(START + u for u in units))
        except (BrokenPipeError, ValueError, OSError):
            pass

    def read(self):
        """Luma of the next picture in order of output, uint16 [height, width] (6.1.2)."""
        p = self.parameters
        luma = 2 * p.width * p.height
        data = self.process.stdout.read(luma + luma // 2)
        if len(data) != luma + luma // 2:
            self._fail("gives fewer pictures than there are samples")
        picture = np.frombuffer(data, dtype="<u2", count=p.width * p.height)
        return picture.reshape(p.height, p.width)

    def finish(self):
        """Check that there are no more pictures and no errors (6.2.5.2, 6.2.8)."""
        if self.process.stdout.read(1):
            self._fail("gives more pictures than there are samples")
        self.feeder.join()
        if self.process.wait() or self._messages():
            self._fail("reports errors")
        self.close()

    def _messages(self):
        """What ffmpeg wrote."""
        self.errors.seek(0)
        return self.errors.read(4000).decode("utf-8", "replace").strip()

    def _fail(self, what):
        """Reject the picture."""
        self.close()
        text = " | ".join(self._messages().splitlines()[:2])
        raise Damaged("6.2.5.2", f"the H.264 decoder {what}" + (f" ({text})" if text else ""))

    def close(self):
        """End ffmpeg if it still runs."""
        if self.process.poll() is None:
            self.process.stdout.close()
            self.process.terminate()
            self.process.wait()
        self.feeder.join()


class Pictures:
    """Luma planes of all frames in order of presentation, fragment by fragment."""

    def __init__(self, fragments, parameters):
        if not shutil.which("ffmpeg"):
            raise Limit("6.2", "the program ffmpeg is not installed")
        self.parameters = parameters
        self.fragments = iter(fragments)
        self.decoder = None
        self.left = 0

    def next(self, where):
        """Luma plane of the next frame, uint16 [3 plane_height, width]."""
        if self.left == 0:
            fragment = next(self.fragments)
            self.left = fragment.count
            self.decoder = Decoder(fragment, self.parameters)
        with placed(where):
            picture = self.decoder.read()
            self.left -= 1
            if self.left == 0:
                self.decoder.finish()
        return picture

    def close(self):
        """End the decoder of the present fragment."""
        if self.decoder:
            self.decoder.close()
