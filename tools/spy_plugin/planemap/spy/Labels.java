// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.awt.Color;
import planemap.plane_map_t;

/** Names and colours of the planes' labels, which lcm-spy itself shows as numbers; as in overhead.svg. */
final class Labels {
    static final byte[] ALL = {plane_map_t.LABEL_FLOOR,      plane_map_t.LABEL_CEILING,  plane_map_t.LABEL_WALL,
                               plane_map_t.LABEL_HORIZONTAL, plane_map_t.LABEL_VERTICAL, plane_map_t.LABEL_OTHER,
                               plane_map_t.LABEL_UNKNOWN};

    private Labels() {}

    static String name(byte label) {
        switch (label) {
            case plane_map_t.LABEL_FLOOR: return "floor";
            case plane_map_t.LABEL_CEILING: return "ceiling";
            case plane_map_t.LABEL_WALL: return "wall";
            case plane_map_t.LABEL_HORIZONTAL: return "horizontal";
            case plane_map_t.LABEL_VERTICAL: return "vertical";
            case plane_map_t.LABEL_OTHER: return "other";
            default: return "unknown";
        }
    }

    static Color color(byte label) {
        switch (label) {
            case plane_map_t.LABEL_FLOOR: return new Color(236, 219, 180);
            case plane_map_t.LABEL_CEILING: return new Color(203, 184, 232);
            case plane_map_t.LABEL_WALL: return new Color(46, 72, 101);
            case plane_map_t.LABEL_HORIZONTAL: return new Color(104, 184, 138);
            case plane_map_t.LABEL_VERTICAL: return new Color(96, 150, 204);
            case plane_map_t.LABEL_OTHER: return new Color(224, 123, 77);
            default: return new Color(170, 170, 170);
        }
    }
}
