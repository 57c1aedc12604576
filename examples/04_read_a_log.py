#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The newest map in an LCM log, a line a plane, in Python without LCM: Debian 12 has no module of it.

  lcm-gen -p --ppath types /usr/share/planemap/lcmtypes/*.lcm      # or lcmtypes/*.lcm of a checkout
  PYTHONPATH=types examples/04_read_a_log.py out/office/plane_map.lcmlog
"""
import struct
import sys

import planemap

LABELS = {getattr(planemap.map_plane_t, name): name[len("LABEL_"):].lower()
          for name in dir(planemap.map_plane_t) if name.startswith("LABEL_")}


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
    for plane in newest.planes:
        nx, ny, nz = plane.normal
        print(f"{plane.id} {LABELS[plane.label]} normal {nx:.4f} {ny:.4f} {nz:.4f} d {plane.d:.4f} area {plane.area:.2f}")


if __name__ == "__main__":
    main()
