// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import bot_core.image_t;
import java.awt.Dimension;
import java.awt.Toolkit;
import java.util.function.Supplier;
import javax.swing.JComponent;
import javax.swing.JFrame;
import javax.swing.Timer;
import lcm.lcm.LCM;
import planemap.plane_map_t;
import planemap.trajectory_t;

/** The windows, which look five times a second for what came last, until they are closed. */
final class Windows {
    private static final int PERIOD_MS = 200;
    /** Where the next window goes: rows as wide as a map, at the right edge of the screen. */
    private static int left;
    private static int top;
    private static int rowHeight;

    private Windows() {}

    static void openMap(String title, Supplier<Object> newestMap) {
        MapPanel panel = new MapPanel();
        // lcm-spy gives a plug-in its own channel only; the trajectory is taken from the bus that
        // LCM_DEFAULT_URL names, which tools/spy sets to the one that it watches.
        Latest<trajectory_t> trajectory = new Latest<>("PLANEMAP_TRAJECTORY", trajectory_t::new);
        LCM.getSingleton().subscribe(trajectory.channel, trajectory);
        open(title, panel, () -> panel.show(as(plane_map_t.class, newestMap), trajectory.get()),
             () -> LCM.getSingleton().unsubscribe(trajectory.channel, trajectory));
    }

    static void openImage(String title, Supplier<Object> newestImage) {
        ImagePanel panel = new ImagePanel();
        open(title, panel, () -> panel.show(as(image_t.class, newestImage)), () -> {});
    }

    private static <T> T as(Class<T> type, Supplier<Object> newest) {
        Object value = newest.get();
        return type.isInstance(value) ? type.cast(value) : null;
    }

    private static void place(JFrame frame) {
        Dimension screen = Toolkit.getDefaultToolkit().getScreenSize();
        int edge = Math.max(0, screen.width - MapPanel.WIDTH_PX);
        if (left + frame.getWidth() > screen.width || left < edge) {
            left = edge;
            top += rowHeight;
            rowHeight = 0;
        }
        if (top + frame.getHeight() > screen.height) top = 0;
        frame.setLocation(left, top);
        left += frame.getWidth();
        rowHeight = Math.max(rowHeight, frame.getHeight());
    }

    private static void open(String title, JComponent panel, Runnable look, Runnable closed) {
        JFrame frame = new JFrame(title);
        Timer timer = new Timer(PERIOD_MS, event -> look.run());
        frame.add(panel);
        frame.pack();
        frame.setDefaultCloseOperation(JFrame.DISPOSE_ON_CLOSE);
        frame.addWindowListener(new java.awt.event.WindowAdapter() {
            @Override
            public void windowClosed(java.awt.event.WindowEvent event) {
                timer.stop();
                closed.run();
            }
        });
        place(frame);
        timer.start();
        frame.setVisible(true);
    }
}
