// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.util.ArrayList;
import java.util.List;
import planemap.plane_map_t;

/** A plane of a map, unpacked from plane_map_t as docs/formats.md has it. */
final class MapPlane {
    private static final double NORMAL_STEP = 1.0 / 65536, D_STEP_M = 0.0005, ANGLE_STEP_RAD = Math.PI / 8192;

    final int id;
    final byte label;
    /** Unit, world frame. */
    final double[] normal;
    /** Of the outline's box, world frame, metres. */
    final double[] center;
    /** The outline's, square metres. */
    final double area;
    /** The outline's, world frame, metres. */
    final List<double[][]> rings = new ArrayList<>();

    /** All planes of a map. Throws IllegalArgumentException for one that makes no sense. */
    static List<MapPlane> of(plane_map_t map) {
        try {
            Numbers numbers = new Numbers(map.packed);
            List<MapPlane> planes = new ArrayList<>();
            long count = numbers.next();
            for (long i = 0, id = -1; i < count; ++i) {
                id += 1 + numbers.nextSigned();
                planes.add(new MapPlane((int) id, numbers, map.unit));
            }
            return planes;
        } catch (IndexOutOfBoundsException error) {
            throw new IllegalArgumentException("the map is cut short");
        }
    }

    private MapPlane(int id, Numbers numbers, double unit) {
        this.id = id;
        label = (byte) numbers.next();
        normal = normal(numbers.nextSigned() * NORMAL_STEP, numbers.nextSigned() * NORMAL_STEP);
        double[] origin = Vectors.scaled(normal, -numbers.nextSigned() * D_STEP_M);
        double angle = numbers.nextSigned() * ANGLE_STEP_RAD;
        for (int skipped = 0; skipped < 3; ++skipped) numbers.next();  // rms, inliers, keyframes
        // The reference direction of the angle: world x laid into the plane; world y where the normal is near x.
        double[] axis = Math.abs(normal[0]) < 0.9 ? new double[] {1, 0, 0} : new double[] {0, 1, 0};
        double[] reference = Vectors.unit(Vectors.minus(axis, Vectors.scaled(normal, Vectors.dot(axis, normal))));
        double[] side = Vectors.cross(normal, reference);
        double[] x = Vectors.plus(Vectors.scaled(reference, Math.cos(angle)), Vectors.scaled(side, Math.sin(angle)));
        double[] y = Vectors.cross(normal, x);
        List<double[][]> flat = new ArrayList<>();
        double[] low = {0, 0}, high = {0, 0};
        long count = numbers.next(), u = 0, v = 0;
        for (long r = 0; r < count; ++r) {
            long size = numbers.next();
            if (size < 3 || size > Short.MAX_VALUE) throw new IllegalArgumentException("a ring of " + size + " vertices");
            double[][] ring = new double[(int) size][], outline = new double[(int) size][];
            for (int i = 0; i < size; ++i) {
                u += numbers.nextSigned();
                v += numbers.nextSigned();
                outline[i] = new double[] {unit * u, unit * v};
                ring[i] = Vectors.plus(origin, Vectors.plus(Vectors.scaled(x, unit * u), Vectors.scaled(y, unit * v)));
                for (int k = 0; k < 2; ++k) {
                    boolean first = r == 0 && i == 0;
                    low[k] = first ? outline[i][k] : Math.min(low[k], outline[i][k]);
                    high[k] = first ? outline[i][k] : Math.max(high[k], outline[i][k]);
                }
            }
            flat.add(outline);
            rings.add(ring);
        }
        center = Vectors.plus(origin, Vectors.plus(Vectors.scaled(x, (low[0] + high[0]) / 2),
                                                   Vectors.scaled(y, (low[1] + high[1]) / 2)));
        double sum = 0;
        for (double[][] outline : flat) sum += signedArea(outline);
        area = Math.abs(sum);
    }

    /** From octahedral coordinates. */
    private static double[] normal(double u, double v) {
        double z = 1 - Math.abs(u) - Math.abs(v);
        double x = z < 0 ? (1 - Math.abs(v)) * (u < 0 ? -1 : 1) : u;
        double y = z < 0 ? (1 - Math.abs(u)) * (v < 0 ? -1 : 1) : v;
        return Vectors.unit(new double[] {x, y, z});
    }

    /** Holes run the other way round. */
    private static double signedArea(double[][] ring) {
        double sum = 0;
        for (int i = 0, j = ring.length - 1; i < ring.length; j = i++) sum += ring[j][0] * ring[i][1] - ring[i][0] * ring[j][1];
        return sum / 2;
    }

    /** Varints: seven bits a byte, the lowest first, the eighth says that more follow. */
    private static final class Numbers {
        private final byte[] bytes;
        private int at;

        Numbers(byte[] bytes) {
            this.bytes = bytes;
        }

        long next() {
            long value = 0;
            for (int shift = 0; shift < 49; shift += 7) {
                byte b = bytes[at++];
                value |= (long) (b & 127) << shift;
                if (b >= 0) return value;
            }
            throw new IllegalArgumentException("a number of more than 49 bits");
        }

        /** 0, -1, 1, -2, 2 ... */
        long nextSigned() {
            long value = next();
            return value >> 1 ^ -(value & 1);
        }
    }
}
