# SPDX-License-Identifier: MIT
"""Valid vectors of lossless files: gvc.md 4.9, 6.4 to 6.9."""
import struct

import numpy

from . import content, exr
from .boxes import Box
from .lossless import add_lossless, all_keyframes, keyframe, lossless_movie, plan_residuals
from .residual import GRADIENT, LEAST_SQUARES
from .scenes import Group, still_codes
from .tables import chart

CHART = (16, (0, 1, 1))


def exact_movie(codes=None, charts=None, previews=None, plan=None, movie_fields=None, groups=1, **fields):
    """A lossless movie: codes of each frame [frame][chart]; by default three frames of bumps that move."""
    charts = charts or [chart(*CHART)]
    codes = codes or [[content.exact_codes(c.size, t) for c in charts] for t in range(3)]
    movie = lossless_movie(charts, bool(previews), **(movie_fields or {}))
    for _ in range(groups):
        add_lossless(movie, Group(charts, codes), plan, previews=previews, **fields)
    return movie


def images(suite):
    """Forms of OpenEXR images."""
    for name, compression in (("none", exr.NONE), ("rle", exr.RLE), ("zips", exr.ZIPS), ("zip", exr.ZIP)):
        flat = [[content.exact_codes(16, t) // 512 * 512] for t in range(2)]
        suite.good("core/exr-" + name, exact_movie(flat, compression=compression), "keyframes with compression " + name.upper(),
                   ["6.5.2", "6.5.4", "5.8"], ["exact", "exr"])
    suite.good("core/exr-noise", exact_movie([[content.exact_codes(16, seed=3)]]), "a keyframe that no compression makes "
               "smaller, so its blocks stand as they are", ["6.5.2", "6.5.4"], ["exact", "exr"])
    edges = numpy.array([0, 1, 31, 32, 33, 63, 64, 32767, 32768, 65503, 65504, 65535])
    codes = edges[content.Lcg(5).array((3, 16, 16), len(edges))].astype(numpy.uint16)
    suite.good("core/exact-codes-extremes", exact_movie([[codes], [65535 - codes], [codes]]), "codes 0, 65535 and those where "
               "halves carry, and residuals as great as can be", ["6.5.4", "6.6.3", "6.6.4", "9.2.1"], ["exact", "codes"])
    suite.good("core/exr-33", exact_movie([[content.exact_codes(33)]], [chart(33, (0, 1, 1))]), "an image of 33 lines: three "
               "blocks of ZIP", ["6.5.2"], ["exact", "exr"])


def attributes(suite):
    """Attributes of keyframes."""
    def make(about, name, clauses, **fields):
        movie = lossless_movie([chart(*CHART)])
        codes = [[content.exact_codes(16)]]

        def swap(images_of):
            images_of[0][0] = keyframe(movie, chart(*CHART), codes[0][0], 0, **fields).encode()
        add_lossless(movie, Group([chart(*CHART)], codes), edit_images=swap)
        suite.good("extended/exr-" + name, movie, about, clauses, ["exact", "exr"])
    long = "a" * 200
    make("attributes with names of more than 31 bytes, and the flag that says so", "long-names", ["6.5.1", "6.5.7"],
         version=b"\x02\x04\0\0", more=((long, "string", b"text"),))
    make("attributes that nobody knows", "other-attributes", ["6.5.7"], more=(
        ("comments", "string", b"something"), ("made", "someType", bytes(range(40))), ("gvcLater", "int", b"\1\0\0\0")))
    make("a displayWindow of another size", "display-window", ["6.5.2"],
         replace={"displayWindow": ("box2i", struct.pack("<4i", -5, 3, 99, 77))})
    make("gvcOrigin and gvcStep that are not those of the record, which holds", "map-differs", ["6.5.6"],
         replace={"gvcOrigin": ("v3d", struct.pack("<3d", 5, 6, 7)), "gvcStep": ("double", struct.pack("<d", 2))})
    movie = exact_movie()
    movie.config.unit = "mm"
    suite.good("extended/exr-unit-differs", movie, "gvcUnit m, while unit is mm", ["6.5.5", "5.5"], ["exact", "exr"])
    movie = lossless_movie([chart(*CHART)])
    movie.config.unit = ""
    add_lossless(movie, Group([chart(*CHART)], [[content.exact_codes(16)]]))
    suite.good("core/exr-no-unit", movie, "no gvcUnit, since unit is empty", ["6.5.5"], ["exact", "exr"])


def residuals(suite):
    """Residual images."""
    for name, predictor, reference in (("gradient-alone", GRADIENT, 0), ("gradient", GRADIENT, 1),
                                       ("least-squares-alone", LEAST_SQUARES, 0), ("least-squares", LEAST_SQUARES, 1)):
        suite.good("core/residual-" + name, exact_movie(plan=plan_residuals(predictor, reference)),
                   "residuals: predictor %d, reference %d" % (predictor, reference),
                   ["6.6.3", "6.6.4", "6.6.5", "6.6.6", "6.7.2", "6.7.3"] + (
                       ["6.8.1"] if predictor == GRADIENT else ["6.9.1", "6.9.2", "6.9.3", "6.9.4", "6.9.5", "6.9.6"]),
                   ["exact", "residual"])
        noise = [[content.exact_codes(16, seed=80 + t)] for t in range(2)]
        suite.good("extended/residual-%s-noise" % name, exact_movie(noise, plan=plan_residuals(predictor, reference)),
                   "residuals of noise: predictor %d, reference %d" % (predictor, reference), ["6.6.4", "6.7.2"],
                   ["exact", "residual"])
    c = chart(33, (0, 1, 1))
    suite.good("core/residual-33", exact_movie([[content.exact_codes(33, t)] for t in (0, 1)], [c],
                                               plan=plan_residuals(LEAST_SQUARES)), "least squares in images of 33 samples",
               ["6.9.4", "6.9.5"], ["exact", "residual"])
    still = [[content.exact_codes(16)]] * 3
    suite.good("core/residual-still", exact_movie(still), "frames that are alike: residuals of a few bytes", ["6.6.7"],
               ["exact", "residual"])

    def mixed(movie, group, number, c, first):
        plans = [all_keyframes, plan_residuals(LEAST_SQUARES, 0), plan_residuals(GRADIENT), plan_residuals(LEAST_SQUARES)]
        return plans[(number - 1) % 4](movie, group, number, c, first)
    six = [[content.exact_codes(16, t)] for t in range(6)]
    suite.good("core/exact-mixed", exact_movie(six, plan=mixed), "a group of keyframes and residuals of all kinds",
               ["6.4.3", "11.5.1"], ["exact", "residual", "exr"])
    suite.good("core/exact-all-keyframes", exact_movie(plan=all_keyframes), "all images are keyframes", ["6.4.3"],
               ["exact", "exr"])
    suite.good("core/exact-groups", exact_movie(groups=2), "two groups", ["6.4.3", "6.6.2"], ["exact"])


def tracks(suite):
    """Lossless files with previews, and of several charts."""
    one = [chart(*CHART)]
    suite.good("core/exact-with-preview", exact_movie(previews=still_codes(one, range(3))), "geometry, shape and exact track",
               ["4.9.2", "6.4.1", "7.1.5", "10.3.5", "4.8.1"], ["exact", "preview"])
    c = chart(*CHART)
    movie = lossless_movie([c], True)
    codes = [[content.exact_codes(16, t)] for t in range(3)]
    add_lossless(movie, Group([c], codes, [("I", 0), ("P", 2), ("B", 1)]), previews=still_codes([c], range(3)))
    suite.good("core/exact-with-b-pictures", movie, "a preview with B pictures: tracks in different orders", ["11.4", "4.9.3"],
               ["exact", "preview", "b pictures"])
    movie = exact_movie(previews=still_codes(one, range(3)))
    movie.kinds = ("exact", "shape", "geometry")
    suite.good("extended/exact-track-first", movie, "trak and traf of the exact track come first", ["4.10.2", "4.8.1"],
               ["exact", "preview"])
    movie = exact_movie()
    for run in movie.fragment().runs.values():
        run.offsets = True
    suite.good("extended/exact-offsets", movie, "composition offsets that are all 0", ["4.9.3", "4.7.4"], ["exact", "times"])
    movie = exact_movie(previews=still_codes(one, range(3)))

    def second_configuration(moov):
        moov.get("trak[2]/mdia/minf/stbl/stsd/urim").children.append(Box("gvcC", b"\0\x09nothing"))
    movie.edit_moov = second_configuration
    suite.good("extended/configuration-elsewhere", movie, "a gvcC in the exact track, which is not the main track here",
               ["4.3.4"], ["exact", "gvcC"])
    two = [chart(16, (0, 1, 1)), chart(18, (0, 1), 1, component=1, x=16, step=0.5)]
    suite.good("core/exact-two-charts", exact_movie(charts=two, plan=plan_residuals(LEAST_SQUARES)), "two exact images in each "
               "sample", ["6.4.2", "9.1"], ["exact", "several charts"])
    suite.good("extended/exact-two-charts-with-preview", exact_movie(charts=two, previews=still_codes(two, range(3))),
               "two charts, with a preview", ["6.4.2", "7.1.5"], ["exact", "several charts", "preview"])
    suite.good("core/exact-genus-2", exact_movie(charts=[chart(16, (0, 1), 2)]), "exact images of a surface of genus 2",
               ["8.5", "6.4.4"], ["exact", "genus"])


def everything(suite):
    """All of them."""
    for part in (images, attributes, residuals, tracks):
        part(suite)
