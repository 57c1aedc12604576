// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import bot_core.image_t;
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.util.Arrays;
import java.util.Locale;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import lcm.lcm.LCM;
import planemap.plane_map_t;

/**
 * Opens windows at once, from the bus that LCM_DEFAULT_URL names: Main [map] [color] [depth] [regions]
 * [spy ARGUMENTS...]; what follows spy goes to lcm-spy.
 */
public final class Main {
    private static final int CHANNEL_PX = 260;

    private Main() {}

    public static void main(String[] arguments) {
        for (int i = 0; i < arguments.length; ++i) {
            if (arguments[i].equals("spy")) {
                lcm.spy.Spy.main(Arrays.copyOfRange(arguments, i + 1, arguments.length));
                SwingUtilities.invokeLater(Main::widenChannels);
                return;
            }
            open(arguments[i]);
        }
    }

    /** lcm-spy's column of channels cuts names off, so that those of one kind look alike. */
    private static void widenChannels() {
        for (Frame frame : Frame.getFrames()) widenChannels(frame);
    }

    private static void widenChannels(Container container) {
        for (Component part : container.getComponents()) {
            if (part instanceof JTable) {
                ((JTable) part).getColumnModel().getColumn(0).setPreferredWidth(CHANNEL_PX);
            } else if (part instanceof Container) {
                widenChannels((Container) part);
            }
        }
    }

    private static void open(String name) {
        if (name.equals("map")) {
            Latest<plane_map_t> map = new Latest<>("PLANEMAP_MAP", plane_map_t::new);
            LCM.getSingleton().subscribe(map.channel, map);
            SwingUtilities.invokeLater(() -> Windows.openMap(map.channel, map::get));
            return;
        }
        Latest<image_t> image = new Latest<>("PLANEMAP_PREVIEW_" + name.toUpperCase(Locale.ROOT), image_t::new);
        LCM.getSingleton().subscribe(image.channel, image);
        SwingUtilities.invokeLater(() -> Windows.openImage(image.channel, image::get));
    }
}
