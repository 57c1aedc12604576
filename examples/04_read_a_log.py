#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The newest map in an LCM log, a line a plane, in Python without LCM: Debian 12 has no module of it.

  lcm-gen -p --ppath types /usr/share/planemap/lcmtypes/*.lcm      # or lcmtypes/*.lcm of a checkout
  PYTHONPATH=types examples/04_read_a_log.py out/office/plane_map.lcmlog
"""
import math
import struct
import sys

import planemap

LABELS = {getattr(planemap.plane_map_t, name): name[len("LABEL_"):].lower()
          for name in dir(planemap.plane_map_t) if name.startswith("LABEL_")}


def events(path):
    """Number, microseconds, channel and bytes of each event of a log; raises ValueError where it is damaged."""
    with open(path, "rb") as log:
        while header := log.read(28):
            if len(header) < 28:
                raise ValueError(f"{path}: is cut short")
            sync, number, utime, channel_size, data_size = struct.unpack(">IqqII", header)
            if sync != 0xEDA1DA01:
                raise ValueError(f"{path}: is no LCM log, or a damaged one")
            channel, data = log.read(channel_size), log.read(data_size)
            if len(data) < data_size:
                raise ValueError(f"{path}: is cut short")
            yield number, utime, channel.decode(), data


def numbers(data):
    """What plane_map_t.packed holds: seven bits a byte, the lowest first, the eighth says that more follow."""
    value = shift = 0
    for byte in data:
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            yield value
            value = shift = 0


def unpacked(message):
    """The planes of a plane_map_t, as docs/formats.md has them; rings in metres in the plane, from its point nearest to the
    world's origin. Lines, points and inferred parts follow them."""
    stream = numbers(message.packed)
    number = lambda: next(stream)
    signed = lambda: (lambda n: n >> 1 ^ -(n & 1))(next(stream))
    planes, last_id = [], -1
    for _ in range(number()):
        plane = {"id": last_id + 1 + signed(), "label": number()}
        last_id = plane["id"]
        x, y = signed() / 65536, signed() / 65536
        z = 1 - abs(x) - abs(y)
        if z < 0:
            x, y = math.copysign(1 - abs(y), x), math.copysign(1 - abs(x), y)
        length = math.sqrt(x * x + y * y + z * z)
        plane["normal"] = (x / length, y / length, z / length)
        plane["d"], plane["angle"] = signed() * 0.0005, signed() * math.pi / 8192
        plane["rms"], inliers, plane["keyframes"] = number() * 0.0001, number(), number()
        plane["inliers"] = (inliers & 511) * 2 ** (inliers >> 9)
        plane["rings"], u, v = [], 0, 0
        for _ in range(number()):
            plane["rings"].append([])
            for _ in range(number()):
                u, v = u + signed(), v + signed()
                plane["rings"][-1].append((u * message.unit, v * message.unit))
        planes.append(plane)
    return planes


def area(rings):
    """Holes run the other way round."""
    return abs(sum(a[0] * b[1] - b[0] * a[1] for ring in rings for a, b in zip(ring, ring[1:] + ring[:1]))) / 2


def main():
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} LOG")
    newest = None
    try:
        for _, _, channel, data in events(sys.argv[1]):
            if channel == "PLANEMAP_MAP":
                newest = planemap.plane_map_t.decode(data)
    except (OSError, ValueError) as error:
        sys.exit(str(error))
    if newest is None:
        sys.exit(f"{sys.argv[1]}: holds no map")
    try:
        planes = unpacked(newest)
    except StopIteration:
        sys.exit(f"{sys.argv[1]}: its map is cut short")
    for plane in planes:
        nx, ny, nz = plane["normal"]
        print(f"{plane['id']} {LABELS[plane['label']]} normal {nx:.4f} {ny:.4f} {nz:.4f} d {plane['d']:.4f} "
              f"area {area(plane['rings']):.2f}")


if __name__ == "__main__":
    main()
