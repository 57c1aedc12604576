// SPDX-License-Identifier: BSD-3-Clause
package planemap.spy;

import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/** The newest message of a channel. One that does not decode (another type's, cut short) is left out, and said. */
final class Latest<T> implements LCMSubscriber {
    interface Decoder<T> {
        T decode(java.io.DataInput bytes) throws IOException;
    }

    final String channel;
    private final Decoder<T> decoder;
    private volatile T newest;
    private boolean complained;

    Latest(String channel, Decoder<T> decoder) {
        this.channel = channel;
        this.decoder = decoder;
    }

    T get() {
        return newest;
    }

    @Override
    public void messageReceived(LCM lcm, String name, LCMDataInputStream bytes) {
        try {
            newest = decoder.decode(bytes);
        } catch (IOException | RuntimeException error) {
            if (!complained) System.err.println("planemap: " + name + ": " + error);
            complained = true;
        }
    }
}
