// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("graph", "Keyframes to loop closures and an optimised trajectory.");
    planemap::graph::GraphOptions options;
    planemap::graph::GraphFiles files;
    process.flags().add("o,output", files.output,
                        "Folder for trajectory.txt at the end; without it nothing is written");
    process.flags().add(options_of(options));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        files.journal = process.journal();
        return std::make_unique<planemap::graph::GraphShell>(
            bus, options, planemap::graph::Optimising::kInBackground, files);
    });
}
