// SPDX-License-Identifier: BSD-3-Clause
// planemap-launch: the modules as processes, started, watched and stopped together.
#include <csignal>

#include "launcher/live_run.hpp"
#include "messages/process.hpp"

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-launch",
        "Starts sensor, segmentation, odometry, graph, map and octomap as processes that talk over LCM, and "
        "starts a "
        "module\nagain that dies. Ctrl-C, or the end of the input, stops them in order, each after what it "
        "waits for.\n"
        "\nRecord, and map again from the recording:\n"
        "  planemap-launch --log logs/office.lcmlog\n"
        "  planemap-launch --no-sensor --output out/again &\n"
        "  lcm-logplayer --lcm-url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304' \\\n"
        "      -e 'OPENNI_FRAME|PLANEMAP_CAMERA_INFO' logs/office.lcmlog\n"
        "A frame is larger than the receive buffer that LCM asks for by itself: keep recv_buf_size in the "
        "URL.");
    planemap::launcher::LaunchOptions options;
    options.add_to(flags);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    planemap::messages::start_logging("planemap-launch", false);
    return planemap::messages::run_main("planemap-launch", [&] {
        if (options.bin.empty()) options.bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
        options.check();
        planemap::launcher::Supervisor::block_signals();
        return planemap::launcher::LiveRun(options).run();
    });
}
