# SPDX-License-Identifier: MIT
"""From luma planes to macroblocks and back: what an H.264 decoder makes of the pictures that h264.py writes."""
import numpy

from .h264 import Picture, code


def pad(stream, luma):
    """A picture with the rows and columns that cropping takes away again."""
    height, width = luma.shape
    more = ((0, 16 * stream.mb_rows - height), (0, 16 * stream.mb_columns - width))
    return numpy.pad(luma, more, mode="edge")


def block(padded, stream, at):
    """The 16 x 16 samples of macroblock `at`, as a view."""
    y, x = 16 * (at // stream.mb_columns), 16 * (at % stream.mb_columns)
    return padded[y:y + 16, x:x + 16]


def pcm(padded, stream, at):
    """The macroblock that holds these samples as they are."""
    return ("pcm", block(padded, stream, at).reshape(-1).copy())


def intra_pcm(stream, luma):
    """All macroblocks of a picture as I_PCM."""
    padded = pad(stream, luma)
    return [pcm(padded, stream, at) for at in range(stream.mb_columns * stream.mb_rows)]


def against(stream, luma, predicted):
    """Macroblocks that are as predicted are skipped, others are I_PCM."""
    padded, guess = pad(stream, luma), pad(stream, predicted)
    return ["skip" if (block(padded, stream, at) == block(guess, stream, at)).all() else pcm(padded, stream, at)
            for at in range(stream.mb_columns * stream.mb_rows)]


def _plane_mode(up, left, corner):
    """Intra_16x16_Plane (ISO/IEC 14496-10, 8.3.3.4)."""
    up = numpy.concatenate([[corner], up]).astype(numpy.int64)
    left = numpy.concatenate([[corner], left]).astype(numpy.int64)
    weights = numpy.arange(1, 9)
    h = int((weights * (up[9:17] - up[7::-1])).sum())
    v = int((weights * (left[9:17] - left[7::-1])).sum())
    a, b, c = 16 * int(left[16] + up[16]), (5 * h + 32) >> 6, (5 * v + 32) >> 6
    xy = numpy.arange(-7, 9)
    return ((a + b * xy[None, :] + c * xy[:, None] + 16) >> 5).clip(0, 1023)


def _predict(out, stream, at, mode, first):
    """Intra_16x16 prediction (8.3.3) of macroblock `at` from those of its slice."""
    y, x = 16 * (at // stream.mb_columns), 16 * (at % stream.mb_columns)
    up = out[y - 1, x:x + 16] if at - stream.mb_columns >= first else None
    left = out[y:y + 16, x - 1] if x and at - 1 >= first else None
    if mode == 0:
        return numpy.tile(up, (16, 1))
    if mode == 1:
        return numpy.tile(left[:, None], (1, 16))
    if mode == 3:
        return _plane_mode(up, left, out[y - 1, x - 1])
    known = [line.astype(numpy.int64).sum() for line in (up, left) if line is not None]
    shift = 3 + len(known)
    return numpy.full((16, 16), (sum(known) + (1 << (shift - 1))) >> shift if known else 512)


def reconstruct(stream, mbs, slices=(0,), predicted=None):
    """The decoded luma, cropped. `predicted` is what skipped macroblocks are."""
    out = numpy.zeros((16 * stream.mb_rows, 16 * stream.mb_columns), numpy.uint16)
    guess = None if predicted is None else pad(stream, predicted)
    first = 0
    for at, mb in enumerate(mbs):
        first = at if at in slices else first
        if mb == "skip":
            block(out, stream, at)[:] = block(guess, stream, at)
        elif mb[0] == "pcm":
            block(out, stream, at)[:] = mb[1].reshape(16, 16)
        else:
            block(out, stream, at)[:] = _predict(out, stream, at, mb[1], first)
    return out[:stream.height, :stream.width]


def sparse(stream, luma, lcg, one_in):
    """A small picture: I_PCM at the corner and here and there, else predicted from neighbours in all four ways."""
    padded = pad(stream, luma)
    mbs = []
    for at in range(stream.mb_columns * stream.mb_rows):
        row, column = divmod(at, stream.mb_columns)
        if at == 0 or lcg.below(one_in) == 0:
            mbs.append(pcm(padded, stream, at))
        else:
            modes = [2] + ([0] if row else []) + ([1] if column else []) + ([3] if row and column else [])
            mbs.append(("intra", modes[lcg.below(len(modes))]))
    return mbs


def group(stream, lumas, order, slices=(0,), idr_pic_id=0):
    """Codes a closed group.

    lumas: pictures in presentation order. order: (kind, number) in decoding order, the first of kind I. B pictures are
    no references, P pictures refer to the reference picture before them in decoding order. Gives lists of NAL units in
    decoding order.
    """
    coded, frame_num, references = [], 0, []
    for kind, number in order:
        luma = lumas[number]
        if kind == "I":
            mbs = intra_pcm(stream, luma)
        elif kind == "P":
            mbs = against(stream, luma, lumas[references[-1]])
        else:
            before = lumas[max(r for r in references if r < number)].astype(numpy.int64)
            after = lumas[min(r for r in references if r > number)]
            mbs = against(stream, luma, ((before + after + 1) >> 1).astype(numpy.uint16))
        picture = Picture(kind, mbs, frame_num, 2 * number, idr=not references, reference=kind != "B", slices=slices,
                          idr_pic_id=idr_pic_id)
        coded.append(code(stream, picture))
        if kind != "B":
            references.append(number)
            frame_num += 1
    return coded
