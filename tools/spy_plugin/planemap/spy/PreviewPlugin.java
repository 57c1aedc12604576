// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.awt.event.ActionEvent;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** For channels of image_t: lcm-spy finds it on its class path and asks it at a double-click. */
public final class PreviewPlugin implements SpyPlugin {
    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == bot_core.image_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new AbstractAction("Draw " + channel.name) {
            @Override
            public void actionPerformed(ActionEvent event) {
                Windows.openImage(channel.name, () -> channel.last);
            }
        };
    }
}
