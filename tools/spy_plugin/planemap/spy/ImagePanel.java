// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import bot_core.image_t;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.image.BufferedImage;
import java.io.ByteArrayInputStream;
import java.io.IOException;
import javax.imageio.ImageIO;
import javax.swing.JPanel;

/** An image_t that is a JPEG, as large as the window lets it be. */
final class ImagePanel extends JPanel {
    private image_t shown;
    private BufferedImage picture;
    private String problem = "no image yet";

    ImagePanel() {
        setBackground(Color.DARK_GRAY);
        setPreferredSize(new Dimension(MapPanel.WIDTH_PX / 2, MapPanel.WIDTH_PX * 3 / 8));
    }

    /** null: nothing came yet. Called on Swing's thread. */
    void show(image_t image) {
        if (image == null || image == shown) return;
        shown = image;
        picture = null;
        if (image.pixelformat != image_t.PIXEL_FORMAT_MJPEG) {
            problem = "pixel format " + image.pixelformat + " is not shown, only JPEG";
        } else {
            try {
                picture = ImageIO.read(new ByteArrayInputStream(image.data));
                problem = picture == null ? "no JPEG" : "";
            } catch (IOException error) {
                problem = "no JPEG: " + error.getMessage();
            }
        }
        repaint();
    }

    @Override
    protected void paintComponent(Graphics g) {
        super.paintComponent(g);
        if (picture == null) {
            g.setColor(Color.WHITE);
            g.drawString(problem, 20, 30);
            return;
        }
        double scale = Math.min(getWidth() / (double) picture.getWidth(), getHeight() / (double) picture.getHeight());
        int width = (int) (scale * picture.getWidth()), height = (int) (scale * picture.getHeight());
        g.drawImage(picture, (getWidth() - width) / 2, (getHeight() - height) / 2, width, height, null);
    }
}
