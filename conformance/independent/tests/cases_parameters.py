# SPDX-License-Identifier: MIT
"""Forged avcC and parameter sets (gvc.md 6.2.1, 6.2.4)."""

import struct

CASES = []
BASE = "lossy"
AVCC = "trak0/mdia/minf/stbl/stsd/avc1/avcC"


def avcc(name, status, clause, function):
    def change(p):
        n = p.moov.find(AVCC)
        n.head = function(n.head)
    CASES.append((name, BASE, status, clause, change))


def set_byte(at, value):
    return lambda v: v[:at] + bytes([value]) + v[at + 1:]


avcc("avcC version 2", 1, "6.2.4", set_byte(0, 2))
avcc("avcC profile 100", 3, "6.2.1", set_byte(1, 100))
avcc("avcC length size 2", 1, "6.2.4", set_byte(4, 0xFD))
avcc("avcC no SPS", 1, "6.2.4", set_byte(5, 0xE0))
avcc("avcC two SPS", 1, "6.2.4", set_byte(5, 0xE2))
avcc("avcC SPS of type 8", 1, "6.2.4", set_byte(8, 0x68))
avcc("avcC profile_idc 100", 3, "6.2.1", set_byte(9, 100))
avcc("avcC profile_idc 122", 3, "6.2.1", set_byte(9, 122))
avcc("avcC cut", 1, None, lambda v: v[:20])
avcc("avcC empty", 1, "6.2.4", lambda v: b"")
avcc("avcC without the last fields", 0, "", lambda v: v[:-4])
avcc("avcC more behind", 0, "", lambda v: v + b"abc")
avcc("avcC long SPS", 1, "6.2.4", lambda v: v[:6] + struct.pack(">H", 1025) +
     (v[8:8 + v[7]] + b"\x55" * 1025)[:1025] + v[8 + v[7]:])
avcc("avcC two PPS", 1, "6.2.4", lambda v: v[:8 + v[7]] + b"\2" + v[9 + v[7]:])


def bits_to_nal(head, text):
    """NAL unit of a header byte and bits as text, with stop bit and emulation prevention."""
    text += "1"
    text += "0" * (-len(text) % 8)
    data, out, zeros = int(text, 2).to_bytes(len(text) // 8, "big"), bytearray([head]), 0
    for byte in data:
        if zeros >= 2 and byte <= 3:
            out.append(3)
            zeros = 0
        out.append(byte)
        zeros = zeros + 1 if byte == 0 else 0
    return bytes(out)


def ue(n):
    return "0" * ((n + 1).bit_length() - 1) + format(n + 1, "b")


def make_sps(like, **change):
    """SPS of 48 x 144 samples with the numbers of bits of the Parameters `like`."""
    f = {"profile": 110, "id": 0, "chroma": 1, "luma": 2, "chroma_bits": 2, "bypass": 0,
         "frame_num": like.frame_num_bits - 4, "poc": 0, "refs": 4, "gaps": 0, "columns": 2,
         "rows": 8, "mbs_only": 1, "crop": None}
    f.update(change)
    text = format(f["profile"], "08b") + "00000000" + format(13, "08b") + ue(f["id"])
    text += ue(f["chroma"]) + ("0" if f["chroma"] == 3 else "") + ue(f["luma"])
    text += ue(f["chroma_bits"]) + str(f["bypass"]) + "0" + ue(f["frame_num"]) + ue(f["poc"])
    text += {0: ue(like.lsb_bits - 4), 1: "1" + "1" + "1" + ue(0)}.get(f["poc"], "")
    text += ue(f["refs"]) + str(f["gaps"]) + ue(f["columns"]) + ue(f["rows"]) + str(f["mbs_only"])
    text += ("" if f["mbs_only"] else "0") + "1"
    text += "0" if f["crop"] is None else "1" + "".join(map(ue, f["crop"]))
    return bits_to_nal(0x67, text + "0")


def sps(name, status, clause, **change):
    """Another sequence parameter set."""
    def replace(p):
        n, new = p.moov.find(AVCC), make_sps(p.file.head.avc, **change)
        n.head = n.head[:6] + struct.pack(">H", len(new)) + new + n.head[8 + n.head[7]:]
    CASES.append((f"SPS: {name}", BASE, status, clause, replace))


sps("as it was", 0, "")
sps("profile 100", 3, "6.2.1", profile=100)
sps("profile 244", 3, "6.2.1", profile=244)
sps("monochrome", 1, "6.2.1", chroma=0)
sps("4:2:2", 1, "6.2.1", chroma=2)
sps("4:4:4", 1, "6.2.1", chroma=3)
sps("8 bits luma", 1, "6.2.1", luma=0)
sps("8 bits chroma", 1, "6.2.1", chroma_bits=0)
sps("bypass", 1, "6.2.1", bypass=1)
sps("interlaced", 1, "6.2.1", mbs_only=0, rows=4)
sps("gaps", 1, "6.2.1", gaps=1)
sps("17 references", 1, "6.2.1", refs=17)
sps("16 references", 0, "", refs=16)
sps("wider", 1, "6.2.1", columns=3)
sps("wider, cropped on the right", 1, None, columns=3, crop=(0, 8, 0, 0))
sps("higher", 1, "6.2.1", rows=9)
sps("cropped", 1, "6.2.1", crop=(0, 0, 0, 1))
sps("too large", 1, "6.2.1", columns=1 << 19, rows=1 << 19)
sps("cropped below nothing", 1, "6.2.1", crop=(20, 20, 0, 0))
sps("poc type 3", 1, "6.2.1", poc=3)
sps("another id than the PPS names", 1, "6.2.1", id=1)


def make_pps(sps_id=0, groups=0, redundant=0, pps_id=0, weighted=2):
    text = ue(pps_id) + ue(sps_id) + "1" + "0" + ue(groups) + ue(3) + ue(0) + "0"
    text += format(weighted, "02b") + ue(0) + ue(0) + ue(0) + "1" + "0" + str(redundant)
    return bits_to_nal(0x68, text)


def pps(name, **change):
    new = make_pps(**change)
    new = b"\1" + struct.pack(">H", len(new)) + new
    avcc(f"PPS: {name}", 1, None, lambda v: v[:8 + v[7]] + new)


pps("slice groups", groups=1)
pps("redundant pictures", redundant=1)
pps("another id", pps_id=1)
pps("another SPS", sps_id=1)
pps("weighted_bipred_idc 3", weighted=3)
