// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.Shape;
import java.awt.geom.AffineTransform;
import java.awt.geom.Path2D;
import java.awt.geom.Point2D;
import java.awt.geom.Rectangle2D;
import java.util.ArrayList;
import java.util.List;
import javax.swing.JPanel;
import planemap.plane_map_t;
import planemap.trajectory_t;

/** The plane map from above: outlines by label, ids and names, the trajectory, a scale, a legend. */
final class MapPanel extends JPanel {
    static final int WIDTH_PX = 740;
    private static final int HEIGHT_PX = 540, MARGIN_PX = 30, LEGEND_PX = 150, FOOT_PX = 40;
    private static final double LEAST_NAMED_M2 = 0.3;
    private static final Color TRAJECTORY = new Color(179, 20, 42);

    private plane_map_t map;
    private List<MapPlane> planes = new ArrayList<>();
    private String problem = "no map yet";
    private trajectory_t trajectory;

    MapPanel() {
        setBackground(Color.WHITE);
        setPreferredSize(new Dimension(WIDTH_PX, HEIGHT_PX));
    }

    /** Either may be null: not known yet. Called on Swing's thread. */
    void show(plane_map_t newMap, trajectory_t newTrajectory) {
        if (newMap == map && newTrajectory == trajectory) return;
        if (newMap != map) unpack(newMap);
        trajectory = newTrajectory;
        repaint();
    }

    private void unpack(plane_map_t newMap) {
        map = newMap;
        problem = "no map yet";
        planes = new ArrayList<>();
        if (map == null) return;
        try {
            planes = MapPlane.of(map);
            problem = "";
        } catch (IllegalArgumentException error) {
            problem = error.getMessage();
        }
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        super.paintComponent(graphics);
        Graphics2D g = (Graphics2D) graphics.create();
        g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
        if (!problem.isEmpty()) {
            g.drawString(problem, MARGIN_PX, MARGIN_PX);
        } else {
            drawMap(g, new MapGeometry(map));
        }
        g.dispose();
    }

    private void drawMap(Graphics2D g, MapGeometry geometry) {
        List<Drawn> all = new ArrayList<>();
        Rectangle2D bounds = null;
        Path2D path = trajectoryPath(geometry);
        if (path != null) bounds = path.getBounds2D();
        for (MapPlane plane : planes) {
            Drawn drawn = new Drawn(plane, geometry);
            if (drawn.shape.getCurrentPoint() == null) continue;
            all.add(drawn);
            Rectangle2D own = drawn.shape.getBounds2D();
            bounds = bounds == null ? own : bounds.createUnion(own);
        }
        drawLegend(g, geometry);
        if (bounds == null) return;
        AffineTransform pageFromLevel = fit(bounds);
        // What lies level first, the largest lowest, so that walls stand on it.
        all.sort((a, b) -> a.upright != b.upright ? (a.upright ? 1 : -1) : Double.compare(b.plane.area, a.plane.area));
        for (Drawn drawn : all) drawn.draw(g, pageFromLevel);
        if (path != null) {
            g.setColor(TRAJECTORY);
            g.setStroke(new BasicStroke(2, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND));
            g.draw(pageFromLevel.createTransformedShape(path));
        }
        // Names that do not cover each other, the largest planes' first.
        all.sort((a, b) -> Double.compare(b.plane.area, a.plane.area));
        List<Rectangle2D> taken = new ArrayList<>();
        for (Drawn drawn : all) drawn.drawName(g, pageFromLevel, taken);
        drawScale(g, pageFromLevel.getScaleX());
    }

    /** A plane's outline from above. */
    private static final class Drawn {
        final MapPlane plane;
        final boolean upright;
        final Path2D shape = new Path2D.Double(Path2D.WIND_EVEN_ODD);
        private final double[] middle;

        Drawn(MapPlane plane, MapGeometry geometry) {
            this.plane = plane;
            upright = geometry.isUpright(plane);
            middle = geometry.fromAbove(plane.center);
            for (double[][] ring : plane.rings) {
                for (int i = 0; i < ring.length; ++i) {
                    double[] p = geometry.fromAbove(ring[i]);
                    if (i == 0) shape.moveTo(p[0], p[1]);
                    else shape.lineTo(p[0], p[1]);
                }
                if (ring.length > 0) shape.closePath();
            }
        }

        void draw(Graphics2D g, AffineTransform pageFromLevel) {
            if (plane.label == plane_map_t.LABEL_CEILING) return;
            Shape drawn = pageFromLevel.createTransformedShape(shape);
            Color color = Labels.color(plane.label);
            g.setStroke(new BasicStroke(upright ? 3 : 1));
            if (!upright) {
                g.setColor(new Color(color.getRed(), color.getGreen(), color.getBlue(), 110));
                g.fill(drawn);
            }
            g.setColor(upright ? color : color.darker());
            g.draw(drawn);
        }

        void drawName(Graphics2D g, AffineTransform pageFromLevel, List<Rectangle2D> taken) {
            if (plane.area < LEAST_NAMED_M2 || plane.label == plane_map_t.LABEL_CEILING) return;
            Point2D at = pageFromLevel.transform(new Point2D.Double(middle[0], middle[1]), null);
            String name = plane.id + " " + Labels.name(plane.label);
            int width = g.getFontMetrics().stringWidth(name), height = g.getFontMetrics().getAscent();
            Rectangle2D place =
                new Rectangle2D.Double(at.getX() - width / 2.0 - 2, at.getY() - height / 2.0, width + 4, height + 2);
            for (Rectangle2D other : taken)
                if (other.intersects(place)) return;
            taken.add(place);
            g.setColor(new Color(255, 255, 255, 190));
            g.fill(place);
            g.setColor(Color.BLACK);
            g.drawString(name, (float) (at.getX() - width / 2.0), (float) (at.getY() + height / 2.0));
        }
    }

    private Path2D trajectoryPath(MapGeometry geometry) {
        if (trajectory == null || trajectory.n_keyframes == 0) return null;
        Path2D path = new Path2D.Double();
        for (int i = 0; i < trajectory.n_keyframes; ++i) {
            double[] p = geometry.fromAbove(trajectory.world_from_camera[i].translation);
            if (i == 0) path.moveTo(p[0], p[1]);
            else path.lineTo(p[0], p[1]);
        }
        return path;
    }

    /** Level metres to the page beside the legend; ahead is up the page. */
    private AffineTransform fit(Rectangle2D bounds) {
        double width = Math.max(getWidth() - 2 * MARGIN_PX - LEGEND_PX, 10);
        double height = Math.max(getHeight() - 2 * MARGIN_PX - FOOT_PX, 10);
        double scale = Math.min(width / Math.max(bounds.getWidth(), 0.5), height / Math.max(bounds.getHeight(), 0.5));
        AffineTransform page = AffineTransform.getTranslateInstance(MARGIN_PX + width / 2, MARGIN_PX + height / 2);
        page.scale(scale, -scale);
        page.translate(-bounds.getCenterX(), -bounds.getCenterY());
        return page;
    }

    private void drawLegend(Graphics2D g, MapGeometry geometry) {
        int x = getWidth() - LEGEND_PX, y = MARGIN_PX;
        for (byte label : Labels.ALL) {
            int count = 0;
            for (MapPlane plane : planes) count += plane.label == label ? 1 : 0;
            if (count == 0) continue;
            g.setColor(Labels.color(label));
            g.fillRect(x, y - 10, 14, 12);
            g.setColor(Color.BLACK);
            g.drawString(Labels.name(label) + " (" + count + ")", x + 22, y);
            y += 20;
        }
        String drawn = trajectory == null ? "no trajectory yet" : trajectory.n_keyframes + " keyframes";
        g.setColor(TRAJECTORY);
        g.fillRect(x, y - 6, 14, 3);
        g.setColor(Color.BLACK);
        g.drawString(drawn, x + 22, y);
        g.drawString(planes.size() + " planes" + (geometry.upIsKnown ? "" : "; up is not known"), MARGIN_PX, getHeight() - 12);
    }

    private void drawScale(Graphics2D g, double pixelsPerMetre) {
        double length = Math.pow(10, Math.floor(Math.log10(120 / pixelsPerMetre)));
        for (double factor : new double[] {5, 2}) {
            if (factor * length * pixelsPerMetre <= 120) {
                length *= factor;
                break;
            }
        }
        int x = getWidth() - LEGEND_PX, y = getHeight() - 16, end = x + (int) Math.round(length * pixelsPerMetre);
        g.setColor(Color.BLACK);
        g.setStroke(new BasicStroke(2));
        g.drawLine(x, y, end, y);
        g.drawLine(x, y - 4, x, y + 4);
        g.drawLine(end, y - 4, end, y + 4);
        g.drawString((length < 1 ? Float.toString((float) length) : Long.toString(Math.round(length))) + " m", x, y - 8);
    }
}
