// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import planemap.plane_map_t;

/** Where the planes of a map lie, seen from above: metres in a level frame. */
final class MapGeometry {
    /** Axes of the level frame in the world: right and ahead of the first camera, and up. */
    private final double[] right;
    private final double[] ahead;
    final double[] up;
    final boolean upIsKnown;

    MapGeometry(plane_map_t map) {
        double[] told = {map.up[0], map.up[1], map.up[2]};
        upIsKnown = Vectors.norm(told) > 0.5;
        up = upIsKnown ? Vectors.unit(told) : new double[] {0, -1, 0};
        double[] forward = laidLevel(new double[] {0, 0, 1});
        // A first camera that looked straight down or up: the top of its image is ahead.
        if (Vectors.norm(forward) < 0.1) forward = laidLevel(new double[] {0, -1, 0});
        ahead = Vectors.unit(forward);
        right = Vectors.cross(ahead, up);
    }

    /** x to the right and y ahead of the first camera. */
    double[] fromAbove(double[] world) {
        return new double[] {Vectors.dot(right, world), Vectors.dot(ahead, world)};
    }

    boolean isUpright(MapPlane plane) {
        return Math.abs(Vectors.dot(up, plane.normal)) < 0.5;
    }

    private double[] laidLevel(double[] v) {
        return Vectors.minus(v, Vectors.scaled(up, Vectors.dot(v, up)));
    }
}
