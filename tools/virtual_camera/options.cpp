// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_camera/options.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace planemap::virtual_camera {

void Options::validate() const {
    check_options("virtual camera", *this);
}

OptionList options_of(Options& options) {
    OptionList list("Virtual camera");
    list.add("rate", options.rate_hz, {1, 120, "Hz"}, "Frames a second");
    list.add("color", options.color, {"yes", "no"},
             "no: a camera whose colour is no OpenNI2 stream, as the Astra Pro");
    list.add(
        "registration", options.registration, {"works", "refused", "ignored", "late"},
        "Of depth to colour: ignored is accepted and not done, late is done only when it is set after the "
        "streams started");
    list.add("jitter_ms", options.jitter_ms, {0, 1000},
             "Frames arrive up to this much later than they were taken");
    list.add("drop", options.drop, kShare, "Share of depth frames that are lost");
    list.add("color_drop", options.color_drop, kShare, "Share of colour frames that are lost");
    list.add("color_offset_ms", options.color_offset_ms, {0, 1000},
             "Colour is taken this much after depth: streams that are not synchronised");
    list.add("clock_ppm", options.clock_ppm, {-1000, 1000, "ppm"}, "The device's clock goes fast by this");
    list.add("clock_reset_s", options.clock_reset_s, at_least(0),
             "The device's clock starts again at this time; 0: never");
    list.add("freeze_s", options.freeze_s, at_least(0),
             "From this time on no frame comes, until the device is opened again; 0: never");
    list.add("unplug_s", options.unplug_s, at_least(0), "The device is unplugged at this time; 0: never");
    list.add("back_s", options.back_s, at_least(0),
             "And is plugged in again this much later; 0: it does not come back");
    list.add("once", options.once, "Do not begin the input again at its end: nothing comes from there on");
    list.add("seed", options.seed, at_least(0), "Of jitter and of what is lost");
    return list;
}

std::string to_text(Order order) {
    std::string text = order.input + "\n";
    const OptionList list = options_of(order.options);
    for (const Option& option : list.options()) {
        const bool* const flag =
            std::holds_alternative<bool*>(option.field) ? std::get<bool*>(option.field) : nullptr;
        text += option.name + "=" + (flag == nullptr ? option.value() : *flag ? "1" : "0") + "\n";
    }
    return text;
}

Order read_order(const std::string& text) {
    Order order;
    std::istringstream lines(text);
    std::getline(lines, order.input);
    const OptionList list = options_of(order.options);
    for (std::string line; std::getline(lines, line);) {
        const auto equals = line.find('=');
        const auto option = std::find_if(list.options().begin(), list.options().end(),
                                         [&](const Option& o) { return o.name == line.substr(0, equals); });
        if (equals == std::string::npos || option == list.options().end())
            throw std::invalid_argument("virtual camera: \"" + line + "\" is none of its options");
        option->set(line.substr(equals + 1));
    }
    order.options.validate();
    return order;
}

}  // namespace planemap::virtual_camera
