// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.image.BufferedImage;
import java.io.DataInputStream;
import java.io.File;
import java.io.FileInputStream;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import javax.imageio.ImageIO;
import planemap.plane_map_t;
import planemap.trajectory_t;
import planemap.transform_t;

/**
 * What the window of PLANEMAP_MAP draws, painted without a display: MapPictureTest MAP.lcmlog RINGS.txt [PICTURE.png].
 * RINGS.txt has the first vertex of each plane's outline and its area as planes.json has them, a line "id x y z area" each.
 */
public final class MapPictureTest {
    private MapPictureTest() {}

    public static void main(String[] arguments) throws Exception {
        plane_map_t map = readMap(arguments[0]);
        checkRings(map, arguments[1]);
        BufferedImage picture = paint(map, path());
        checkColors(map, picture);
        if (arguments.length > 2) ImageIO.write(picture, "png", new File(arguments[2]));
        for (int size = 0; size < map.packed.length; size += 7) {  // a map that is cut short is said to be
            plane_map_t cut = map.copy();
            cut.packed = java.util.Arrays.copyOf(map.packed, size);
            paint(cut, null);
        }
        require(count(paint(null, null), Labels.color(plane_map_t.LABEL_FLOOR)) == 0, "something is drawn of no map");
        byte[] broken = {1, 2, 3};
        ImagePanel panel = new ImagePanel();
        panel.setSize(100, 100);
        bot_core.image_t image = new bot_core.image_t();
        image.pixelformat = bot_core.image_t.PIXEL_FORMAT_MJPEG;
        image.data = broken;
        panel.show(image);
        panel.paint(new BufferedImage(100, 100, BufferedImage.TYPE_INT_RGB).getGraphics());
        System.out.println(MapPlane.of(map).size() + " planes drawn");
    }

    private static plane_map_t readMap(String file) throws Exception {
        try (DataInputStream log = new DataInputStream(new FileInputStream(file))) {
            log.skipBytes(20);
            int channelSize = log.readInt();
            log.skipBytes(4 + channelSize);
            return new plane_map_t(log);
        }
    }

    private static void checkRings(plane_map_t map, String file) throws Exception {
        List<String> lines = java.nio.file.Files.readAllLines(new File(file).toPath());
        List<MapPlane> planes = MapPlane.of(map);
        require(lines.size() == planes.size(), lines.size() + " planes in " + file);
        for (int i = 0; i < planes.size(); ++i) {
            String[] words = lines.get(i).split(" ");
            double[] p = planes.get(i).rings.get(0)[0];
            require(Integer.parseInt(words[0]) == planes.get(i).id, "ids differ");
            for (int k = 0; k < 3; ++k)
                require(Math.abs(p[k] - Double.parseDouble(words[1 + k])) < 1e-4, "plane " + words[0] + " lies elsewhere");
            require(Math.abs(planes.get(i).area - Double.parseDouble(words[4])) < 1e-3, "plane " + words[0] + " has another area");
        }
    }

    /** A camera that goes one metre ahead. */
    private static trajectory_t path() {
        trajectory_t trajectory = new trajectory_t();
        trajectory.n_keyframes = 2;
        trajectory.world_from_camera = new transform_t[] {new transform_t(), new transform_t()};
        trajectory.world_from_camera[1].translation[2] = 1;
        return trajectory;
    }

    private static BufferedImage paint(plane_map_t map, trajectory_t trajectory) {
        MapPanel panel = new MapPanel();
        panel.setSize(740, 540);
        panel.show(map, trajectory);
        BufferedImage picture = new BufferedImage(740, 540, BufferedImage.TYPE_INT_RGB);
        Graphics2D g = picture.createGraphics();
        panel.paint(g);
        g.dispose();
        return picture;
    }

    /** Each label of the map has its colour in the legend, walls and the trajectory also in the drawing. */
    private static void checkColors(plane_map_t map, BufferedImage picture) {
        Map<Byte, Integer> planes = new HashMap<>();
        for (MapPlane plane : MapPlane.of(map)) planes.merge(plane.label, 1, Integer::sum);
        for (byte label : planes.keySet())
            require(count(picture, Labels.color(label)) >= 14 * 12, Labels.name(label) + " is not in the legend");
        require(count(picture, Labels.color(plane_map_t.LABEL_WALL)) > 14 * 12 + 100, "walls are not drawn");
        require(count(picture, new Color(179, 20, 42)) > 14 * 3 + 20, "the trajectory is not drawn");
    }

    private static int count(BufferedImage picture, Color color) {
        int count = 0;
        for (int y = 0; y < picture.getHeight(); ++y)
            for (int x = 0; x < picture.getWidth(); ++x) count += picture.getRGB(x, y) == color.getRGB() ? 1 : 0;
        return count;
    }

    private static void require(boolean holds, String otherwise) {
        if (!holds) throw new AssertionError(otherwise);
    }
}
