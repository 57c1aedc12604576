// SPDX-License-Identifier: BSD-3-Clause
#include "messages/flags.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace planemap {

class Flags::Impl {
  public:
    Impl(const std::string& program, const std::string& description) : app(description, program) {
        app.set_config("--config", "", "Read flags from an INI or TOML file: one `name = value` a line");
        app.allow_config_extras(CLI::config_extras_mode::error);
    }

    /// "o,output" to "-o,--output", with the section's prefix.
    std::string dashed(const std::string& name) const {
        const auto comma = name.find(',');
        if (comma == std::string::npos) return "--" + prefix + name;
        return "-" + name.substr(0, comma) + ",--" + prefix + name.substr(comma + 1);
    }
    template <typename T>
    void option(const std::string& name, T& field, const std::string& description) {
        finish(app.add_option(dashed(name), field, description)->capture_default_str());
    }
    void finish(CLI::Option* option) {
        if (!heading.empty()) option->group(heading);
        last = option;
    }

    CLI::App app;
    std::string heading, prefix;
    CLI::Option* last = nullptr;
};

Flags::Flags(const std::string& program, const std::string& description)
    : impl_(std::make_unique<Impl>(program, description)) {}
Flags::~Flags() = default;

void Flags::section(const std::string& heading, const std::string& prefix) {
    impl_->heading = heading;
    impl_->prefix = prefix;
}

void Flags::add(const std::string& name, double& field, const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, int& field, const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, std::uint64_t& field, const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, std::string& field, const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, std::filesystem::path& field, const std::string& description) {
    impl_->finish(impl_->app.add_option(impl_->dashed(name), field, description));
}
void Flags::add(const std::string& name, std::optional<double>& field, const std::string& description) {
    impl_->finish(impl_->app.add_option(impl_->dashed(name), field, description));
}
void Flags::add(const std::string& name, std::optional<std::uint64_t>& field,
                const std::string& description) {
    impl_->finish(impl_->app.add_option(impl_->dashed(name), field, description));
}
void Flags::add(const std::string& name, bool& field, const std::string& description) {
    impl_->finish(impl_->app.add_flag(impl_->dashed(name), field, description));
}
void Flags::add_choice(const std::string& name, std::string& field, const std::vector<std::string>& words,
                       const std::string& description) {
    impl_->option(name, field, description);
    impl_->last->check(CLI::IsMember(words));
}
void Flags::required() {
    impl_->last->required();
}
void Flags::add_positional(const std::string& name, std::string& field, const std::string& description,
                           bool required) {
    impl_->finish(impl_->app.add_option(name, field, description)->required(required));
}

int Flags::parse(int argc, const char* const* argv) {
    try {
        impl_->app.parse(argc, argv);
        return -1;
    } catch (const CLI::Success& success) {
        return impl_->app.exit(success);
    } catch (const CLI::Error& error) {
        std::fprintf(stderr, "%s: %s (see --help)\n", impl_->app.get_name().c_str(), error.what());
        return 2;
    }
}

}  // namespace planemap
