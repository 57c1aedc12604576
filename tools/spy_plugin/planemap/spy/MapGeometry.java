// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.util.ArrayList;
import java.util.List;
import planemap.map_plane_t;
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
        upIsKnown = norm(told) > 0.5;
        up = upIsKnown ? scaled(told, 1 / norm(told)) : new double[] {0, -1, 0};
        double[] forward = laidLevel(new double[] {0, 0, 1});
        // A first camera that looked straight down or up: the top of its image is ahead.
        if (norm(forward) < 0.1) forward = laidLevel(new double[] {0, -1, 0});
        ahead = scaled(forward, 1 / norm(forward));
        right = cross(ahead, up);
    }

    /** x to the right and y ahead of the first camera. */
    double[] fromAbove(double[] world) {
        return new double[] {dot(right, world), dot(ahead, world)};
    }

    boolean isUpright(map_plane_t plane) {
        return Math.abs(dot(up, normal(plane))) < 0.5;
    }

    /** The outline's rings in the world frame; map_plane_t and docs/formats.md say how they are packed. */
    static List<double[][]> worldRings(map_plane_t plane) {
        double[] n = scaled(normal(plane), 1 / norm(normal(plane)));
        // The reference direction of the angle: world x laid into the plane; world y where the normal is near x.
        double[] axis = Math.abs(n[0]) > 0.9 ? new double[] {0, 1, 0} : new double[] {1, 0, 0};
        double[] reference = minus(axis, scaled(n, dot(axis, n)));
        reference = scaled(reference, 1 / norm(reference));
        double[] side = cross(n, reference);
        double c = Math.cos(plane.angle), s = Math.sin(plane.angle);
        double[] x = plus(scaled(reference, c), scaled(side, s));
        double[] y = cross(n, x);
        List<double[][]> rings = new ArrayList<>();
        int next = 0;
        for (short size : plane.ring_sizes) {
            double[][] ring = new double[Math.max(0, Math.min(size, plane.n_vertices - next))][];
            for (int i = 0; i < ring.length; ++i, ++next) {
                double u = plane.unit * plane.vertices[next][0], v = plane.unit * plane.vertices[next][1];
                ring[i] = plus(center(plane), plus(scaled(x, u), scaled(y, v)));
            }
            rings.add(ring);
        }
        return rings;
    }

    static double[] center(map_plane_t plane) {
        return new double[] {plane.center[0], plane.center[1], plane.center[2]};
    }

    private static double[] normal(map_plane_t plane) {
        return new double[] {plane.normal[0], plane.normal[1], plane.normal[2]};
    }

    private double[] laidLevel(double[] v) {
        return minus(v, scaled(up, dot(v, up)));
    }

    private static double dot(double[] a, double[] b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    private static double norm(double[] a) {
        return Math.sqrt(dot(a, a));
    }

    private static double[] scaled(double[] a, double factor) {
        return new double[] {factor * a[0], factor * a[1], factor * a[2]};
    }

    private static double[] plus(double[] a, double[] b) {
        return new double[] {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    }

    private static double[] minus(double[] a, double[] b) {
        return plus(a, scaled(b, -1));
    }

    private static double[] cross(double[] a, double[] b) {
        return new double[] {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
}
