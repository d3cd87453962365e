# SPDX-License-Identifier: MIT
"""frame_num sequence (gvc.md 6.2.6), picture order counts (6.2.7; ISO/IEC 14496-10 8.2.1)."""

from .errors import Damaged


class Order:
    """Follows the pictures of a fragment in decoding order; finds their picture order counts."""

    def __init__(self, p):
        self.p = p
        self.range = 1 << p.frame_num_bits
        self.frame_num = None      # of the reference picture before
        self.last_frame_num = 0    # of the picture before
        self.offset = 0            # FrameNumOffset
        self.msb = self.lsb = 0    # of the reference picture before

    def place(self, s):
        """Picture order count of the picture with slice header s: its place in output."""
        self.check_frame_num(s)
        count = min((self.by_lsb, self.by_cycle, self.by_frame_num)[self.p.order_type](s))
        self.last_frame_num = s.frame_num
        if s.ref:
            self.frame_num = s.frame_num
        return count

    def check_frame_num(self, s):
        """6.2.6: 0 in the IDR picture, then one more than that of the reference before."""
        if s.idr:
            if s.frame_num:
                raise Damaged("6.2.6", f"frame_num {s.frame_num} in an IDR picture")
        elif (s.frame_num - self.frame_num) % self.range != 1:
            raise Damaged("6.2.6", f"frame_num {s.frame_num} after {self.frame_num}: "
                                   "a reference is missing")

    def by_lsb(self, s):
        """Picture order count of type 0 (8.2.1.1)."""
        wrap = 1 << self.p.lsb_bits
        msb, lsb = (0, 0) if s.idr else (self.msb, self.lsb)
        if s.lsb < lsb and lsb - s.lsb >= wrap // 2:
            msb += wrap
        elif s.lsb > lsb and s.lsb - lsb > wrap // 2:
            msb -= wrap
        if s.ref:
            self.msb, self.lsb = msb, s.lsb
        return msb + s.lsb, msb + s.lsb + s.bottom

    def step_offset(self, s):
        """FrameNumOffset of types 1 and 2."""
        if s.idr:
            self.offset = 0
        elif self.last_frame_num > s.frame_num:
            self.offset += self.range

    def by_cycle(self, s):
        """Picture order count of type 1 (8.2.1.2)."""
        self.step_offset(s)
        cycle = self.p.cycle
        number = self.offset + s.frame_num if cycle else 0
        if not s.ref and number > 0:
            number -= 1
        expected = 0
        if number > 0:
            expected = (number - 1) // len(cycle) * sum(cycle)
            expected += sum(cycle[:(number - 1) % len(cycle) + 1])
        if not s.ref:
            expected += self.p.non_ref
        top = expected + s.delta[0]
        return top, top + self.p.top_to_bottom + s.delta[1]

    def by_frame_num(self, s):
        """Picture order count of type 2 (8.2.1.3)."""
        self.step_offset(s)
        count = 0 if s.idr else 2 * (self.offset + s.frame_num) - (not s.ref)
        return count, count


def check_output(places, numbers):
    """Pictures are output in the order of their presentation numbers (6.2.7)."""
    if len(set(places)) != len(places):
        raise Damaged("6.2.7", "two pictures of a fragment have the same picture order count")
    by_place = sorted(range(len(places)), key=places.__getitem__)
    found = [numbers[i] for i in by_place]
    if found != sorted(found):
        bad = next(i for i, (a, b) in enumerate(zip(found, sorted(found))) if a != b)
        raise Damaged("6.2.7", f"picture {bad} in order of output is frame {found[bad]}")
