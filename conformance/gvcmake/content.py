# SPDX-License-Identifier: MIT
"""What the images show: smooth bumps and pseudo-random numbers, in integer arithmetic that gives the same for ever."""
import functools

import numpy


class Lcg:
    """Numbers of a fixed generator (x -> 6364136223846793005 x + 1442695040888963407 mod 2^64)."""

    def __init__(self, seed):
        self.state = seed

    def below(self, limit):
        """A number from 0 to limit - 1."""
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % (1 << 64)
        return (self.state >> 33) % limit

    def array(self, shape, limit):
        """An array of such numbers."""
        count = int(numpy.prod(shape))
        return numpy.array([self.below(limit) for _ in range(count)], numpy.int64).reshape(shape)


def kept(make):
    """Keeps what a function made, for it is asked for again and again; nobody may write into it."""
    @functools.lru_cache(maxsize=256)
    def made(*args, **fields):
        out = make(*args, **fields)
        out.setflags(write=False)
        return out
    return functools.wraps(make)(made)


def wave(phase):
    """A wave of period 256 between 0 and 255: parabolas instead of a sine."""
    t = phase % 256
    half = t % 128
    hump = half * (128 - half) // 32
    return numpy.where(t < 128, 128 + hump - 1, 128 - hump).clip(0, 255)


@kept
def smooth(size, time=0):
    """10-bit values [3][S][S] of a bumpy surface that moves with `time`."""
    i, j = numpy.meshgrid(numpy.arange(size) * 256 // size, numpy.arange(size) * 256 // size)
    x = 2 * wave(i + 8 * time) + wave(2 * j) + wave(3 * i + j)
    y = 2 * wave(j + 64) + wave(i + 3 * j + 5 * time) + wave(2 * i)
    z = 2 * wave(i + j) + wave(j - i + 16 * time) + wave(5 * i)
    return numpy.stack([x, y, z]).astype(numpy.int64)


@kept
def noise(size, seed):
    """10-bit values [3][S][S] without any order."""
    return Lcg(seed).array((3, size, size), 1024)


def codes_of(luma):
    """gvc.md 6.3.1."""
    return (luma.astype(numpy.int64) << 6).astype(numpy.uint16)


@kept
def exact_codes(size, time=0, seed=None):
    """16-bit codes [3][S][S]: the bumps with finer steps, or noise."""
    if seed is not None:
        return Lcg(seed).array((3, size, size), 65536).astype(numpy.uint16)
    fine = 64 * smooth(size, time) + smooth(size, 3 * time) // 16
    return fine.astype(numpy.uint16)
