// SPDX-License-Identifier: BSD-3-Clause
#include "messages/flags.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>
#include <type_traits>

#include "core/nearest_name.hpp"
#include "core/standard_output.hpp"
#include "core/version.hpp"

namespace planemap::messages {

namespace {

/// ", did you mean X?", or nothing.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& names,
                         const std::string& lead) {
    const std::string nearest = nearest_name(word, names);
    return nearest.empty() ? "" : ", did you mean " + lead + nearest + "?";
}

std::string one_dash_too_few(const std::string& word) {
    return "unknown flag " + word + ", did you mean -" + word + "?";
}

/// Long names without dashes.
std::vector<std::string> long_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back(name);
    return names;
}

/// What is wrong with an option's text; empty if nothing. May write it in the one way that CLI11 reads right.
using Check = std::function<std::string(std::string&)>;
using Checks = std::map<const CLI::Option*, Check>;

/// CLI11's own reading takes 010 for 8, -1 for the largest number there is, and nan for a number.
template <typename T>
std::string check_number(std::string& text) {
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    T value{};
    const auto [stop, error] = std::from_chars(begin, end, value);
    bool good = error == std::errc() && stop == end;
    if constexpr (std::is_floating_point_v<T>) {
        if (good && std::isfinite(value)) return "";
        return "\"" + text + "\" is no finite number";
    } else {
        if (!good) {
            return "\"" + text + "\" is no whole number from " +
                   std::to_string(std::numeric_limits<T>::min()) + " to " +
                   std::to_string(std::numeric_limits<T>::max());
        }
        text = std::to_string(value);
        return "";
    }
}

std::string check_text(std::string& text) {
    return text.empty() ? "must not be empty" : "";
}

/// By the field that an option writes to.
Check check_of(double& /*field*/) {
    return check_number<double>;
}
Check check_of(int& /*field*/) {
    return check_number<int>;
}
Check check_of(std::uint64_t& /*field*/) {
    return check_number<std::uint64_t>;
}
Check check_of(std::string& /*field*/) {
    return check_text;
}
Check check_of(std::filesystem::path& /*field*/) {
    return check_text;
}
template <typename T>
Check check_of(std::optional<T>& /*field*/) {
    return check_number<T>;
}

/// The file of --config. CLI11's own reader drops what follows a # inside quotes, takes the first of two
/// values without a word, and names no line.
class ConfigFile : public CLI::ConfigBase {
  public:
    ConfigFile(const CLI::App& app, const Checks& checks) : app_(app), checks_(checks) {}

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        std::vector<CLI::ConfigItem> items;
        std::string line;
        for (int number = 1; std::getline(input, line); ++number) {
            if (number == 1 && line.rfind("\xef\xbb\xbf", 0) == 0) line.erase(0, 3);  // a byte order mark
            CLI::detail::trim(line);
            if (line.empty() || line[0] == '#' || line[0] == ';') continue;
            const auto fail = [&](const std::string& reason) {
                throw CLI::ConfigError(std::to_string(number) + ": " + reason);
            };
            const auto equals = line.find('=');
            CLI::ConfigItem item;
            item.name = CLI::detail::trim_copy(line.substr(0, equals));
            const CLI::Option* option = app_.get_option_no_throw("--" + item.name);
            if (option == nullptr) option = app_.get_option_no_throw(item.name);
            if (option == nullptr) {
                fail("unknown option " + item.name + did_you_mean(item.name, long_names(app_), ""));
            }
            if (std::any_of(items.begin(), items.end(), [&](auto& other) { return other.name == item.name; }))
                fail(item.name + " is given twice");
            std::string value = equals == std::string::npos ? "true" : line.substr(equals + 1);
            if (!take_value(value)) fail("the value of " + item.name + " has no end: a \" is missing");
            if (const std::string why = complaint(*option, value); !why.empty()) fail(item.name + ": " + why);
            item.inputs = {value};
            items.push_back(item);
        }
        return items;
    }

  private:
    /// Text in quotes, with \" and \\ inside, or what stands before a comment. False for quotes without end.
    static bool take_value(std::string& value) {
        CLI::detail::trim(value);
        if (value.empty() || (value[0] != '"' && value[0] != '\'')) {
            for (std::size_t i = 0; i < value.size(); ++i) {
                if (value[i] != '#' || (i > 0 && value[i - 1] != ' ' && value[i - 1] != '\t')) continue;
                value.erase(i);
                break;
            }
            CLI::detail::trim(value);
            return true;
        }
        const char quote = value[0];
        std::string text;
        for (std::size_t i = 1; i < value.size(); ++i) {
            if (value[i] == quote) {
                const std::string rest = CLI::detail::trim_copy(value.substr(i + 1));
                value = text;
                return rest.empty() || rest[0] == '#' || rest[0] == ';';
            }
            if (value[i] == '\\' && quote == '"' && i + 1 < value.size()) ++i;
            text += value[i];
        }
        return false;
    }

    /// What is wrong with a value. CLI11 looks at values when it no longer knows where they stood.
    std::string complaint(const CLI::Option& option, std::string value) const {
        if (const auto check = checks_.find(&option); check != checks_.end()) return check->second(value);
        if (option.get_items_expected_max() > 0) return "";
        try {
            CLI::detail::to_flag_value(value);
            return "";
        } catch (const std::invalid_argument&) {
            return "\"" + value + "\" is neither true nor false";
        }
    }

    const CLI::App& app_;
    const Checks& checks_;
};

/// As ConfigFile reads it.
std::string config_text(const FlagValue& flag) {
    return std::visit(
        [](const auto& value) -> std::string {
            using T = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<T, std::monostate>) {
                return "";
            } else if constexpr (std::is_same_v<T, bool>) {
                return value ? "true" : "false";
            } else if constexpr (std::is_same_v<T, std::string>) {
                std::string text = "\"";
                for (const char c : value) text += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
                return text + "\"";
            } else {
                std::array<char, 64> digits;  // the shortest that gives the same number again
                return {digits.data(),
                        std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
            }
        },
        flag.value);
}

template <typename T>
decltype(FlagValue::value) value_of(const T& field) {
    if constexpr (std::is_same_v<T, int>) {
        return std::int64_t{field};
    } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
        return value_of(field.string());
    } else if constexpr (std::is_same_v<T, std::string>) {
        if (field.empty()) return std::monostate{};
        return field;
    } else {
        return field;
    }
}
template <typename T>
decltype(FlagValue::value) value_of(const std::optional<T>& field) {
    if (!field) return std::monostate{};
    return value_of(*field);
}

bool is_flag(const std::string& argument) {
    return argument.size() > 1 && argument != "--" && argument[0] == '-' && argument[1] != '.' &&
           !(argument[1] >= '0' && argument[1] <= '9');
}

}  // namespace

class Flags::Impl {
  public:
    Impl(const std::string& program, const std::string& description) : app(description, program) {
        app.set_config("--config", "", "Read options from a file: one `name = value` a line, # is a comment");
        app.config_formatter(std::make_shared<ConfigFile>(app, checks));
        app.allow_config_extras(CLI::config_extras_mode::error);
        app.set_version_flag("--version", program + " " + version(), "Print the version and exit");
        app.add_flag("--dump-config", dump, "Print all options as a file for --config, and exit")
            ->configurable(false);
    }

    /// "o,output" to "-o,--output".
    static std::string dashed(const std::string& name) {
        const auto comma = name.find(',');
        if (comma == std::string::npos) return "--" + name;
        return "-" + name.substr(0, comma) + ",--" + name.substr(comma + 1);
    }
    template <typename T>
    CLI::Option* option(const std::string& name, T& field, const std::string& description) {
        return checked(app.add_option(dashed(name), field, description), field, check_of(field));
    }
    template <typename T>
    CLI::Option* checked(CLI::Option* option, T& field, const Check& check) {
        option->transform(CLI::Validator(check, ""));
        checks[option] = check;
        finish(option, field);
        return option;
    }
    template <typename T>
    void finish(CLI::Option* option, const T& field) {
        last = option;
        known.push_back({option, [&field] { return value_of(field); }, "", false});
    }

    /// Lets the option be one of the words, on the command line and in a file.
    void choose_of(CLI::Option* option, const std::vector<std::string>& words) {
        const CLI::Validator is_word = CLI::IsMember(words);
        option->check(is_word);
        checks[option] = [is_word](std::string& text) {
            return text.empty() ? std::string("must not be empty") : is_word(text);
        };
    }

    /// The flag of an option that is described in a list.
    void add(const Option& described, const std::string& prefix, const std::string& heading) {
        const std::string name = prefix + described.flag();
        CLI::Option* const option = std::visit(
            [&](auto* field) {
                if constexpr (std::is_same_v<decltype(field), bool*>) {
                    const std::string on = *field ? " [on; --" + name + "=false turns it off]" : "";
                    CLI::Option* const added = app.add_flag(dashed(name), *field, described.help + on);
                    finish(added, *field);
                    return added;
                } else {
                    return this->option(name, *field, help_of(described))->capture_default_str();
                }
            },
            described.field);
        if (!described.choices.empty()) choose_of(option, described.choices);
        option->group(heading);
        known.back().heading = heading;
        known.back().expert = described.audience == Audience::kExpert;
        if (known.back().expert) offer_all();
    }

    /// With what is allowed, and the unit: "largest gap [0 to 100 m]".
    static std::string help_of(const Option& option) {
        const std::string range = option.range_and_unit();
        return range.empty() ? option.help : option.help + " [" + range + "]";
    }

    /// --help-all, for a program with options that --help does not show.
    void offer_all() {
        if (!app.get_footer().empty()) return;
        app.footer("--help-all lists more options.");
        const auto show = [this] {
            help_all = true;
            throw CLI::CallForHelp();
        };
        app.add_flag_callback("--help-all", show, "Print this help message with all options, and exit")
            ->configurable(false);
    }

    /// Before help is printed. CLI11 shows no option without a group, nor names it in an error.
    void choose_for_help() {
        if (help_all) app.footer("");
        for (const Known& flag : known)
            if (flag.expert && !help_all) flag.option->group("");
    }

    std::string name_of(const CLI::Option* option) const {
        return option->get_lnames().empty() ? option->get_name() : option->get_lnames().front();
    }

    /// Of all that CLI11 could not place, what the user should hear of; empty if there is nothing.
    std::string complaint() const {
        std::vector<std::string> rest = app.remaining();
        std::erase(rest, "--");
        const auto unknown = std::find_if(rest.begin(), rest.end(), is_flag);
        if (unknown != rest.end()) {
            const std::string flag = unknown->substr(0, unknown->find('='));
            const std::string word = flag.substr(std::min(flag.find_first_not_of('-'), flag.size()));
            return "unknown flag " + flag + did_you_mean(word, long_names(app), "--");
        }
        return rest.empty() ? "" : "unexpected argument \"" + rest.front() + "\"";
    }

    /// "-output", which CLI11 reads as -o with the value "utput".
    std::string single_dash(int argc, const char* const* argv) const {
        const std::vector<std::string> names = long_names(app);
        for (int i = 1; i < argc; ++i) {
            const std::string argument = argv[i];
            if (argument == "--") break;
            const std::string word = argument.substr(0, argument.find('='));
            if (word.size() > 2 && word[0] == '-' && word[1] != '-' &&
                std::find(names.begin(), names.end(), word.substr(1)) != names.end())
                return one_dash_too_few(word);
        }
        return "";
    }

    std::string config() const {
        std::string text = "# " + app.get_name() + " " + version() + ": all options, for --config\n";
        std::string group;
        for (const auto& [option, value, heading, expert] : known) {
            if (!option->get_configurable()) continue;
            if (heading != group && !heading.empty()) text.append("\n# ").append(heading).append("\n");
            group = heading;
            const std::string written = config_text({"", value()});
            std::string description = option->get_description();
            std::replace(description.begin(), description.end(), '\n', ' ');
            if (written.empty()) text += "# ";
            text.append(name_of(option)).append(" = ").append(written);
            text.append("  # ").append(description).append("\n");
        }
        return text;
    }

    /// Prints what the user asked for; the program's exit code.
    int say(const std::string& text) const {
        try {
            print(text);
            return 0;
        } catch (const std::runtime_error& error) {
            std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
            return 1;
        }
    }

    struct Known {
        CLI::Option* option;
        std::function<decltype(FlagValue::value)()> value;
        std::string heading;  ///< of its module; empty for the program's own
        bool expert;          ///< shown by --help-all only
    };

    Checks checks;
    CLI::App app;
    CLI::Option* last = nullptr;
    std::vector<Known> known;
    bool dump = false, help_all = false;
};

Flags::Flags(const std::string& program, const std::string& description)
    : impl_(std::make_unique<Impl>(program, description)) {}
Flags::~Flags() = default;

void Flags::add(const OptionList& list, const std::string& prefix) {
    for (const Option& option : list.options()) impl_->add(option, prefix, list.heading());
}

void Flags::add(const std::string& name, double& field, const std::string& description) {
    impl_->option(name, field, description)->capture_default_str();
}
void Flags::add(const std::string& name, int& field, const std::string& description) {
    impl_->option(name, field, description)->capture_default_str();
}
void Flags::add(const std::string& name, std::uint64_t& field, const std::string& description) {
    impl_->option(name, field, description)->capture_default_str();
}
void Flags::add(const std::string& name, std::string& field, const std::string& description) {
    impl_->option(name, field, description)->capture_default_str();
}
void Flags::add(const std::string& name, std::filesystem::path& field, const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, std::optional<double>& field, const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, std::optional<std::uint64_t>& field,
                const std::string& description) {
    impl_->option(name, field, description);
}
void Flags::add(const std::string& name, bool& field, const std::string& description) {
    impl_->finish(impl_->app.add_flag(impl_->dashed(name), field, description), field);
}
void Flags::add_choice(const std::string& name, std::string& field, const std::vector<std::string>& words,
                       const std::string& description) {
    impl_->choose_of(impl_->option(name, field, description)->capture_default_str(), words);
}
void Flags::required() {
    impl_->last->required();
}
void Flags::add_positional(const std::string& name, std::string& field, const std::string& description,
                           bool required) {
    CLI::Option* const option = impl_->app.add_option(name, field, description)->required(required);
    // A list of arguments ("FILE...") is the program's own business: one line cannot hold it.
    if (name.ends_with("...")) option->configurable(false);
    impl_->checked(option, field, check_of(field));
}

std::string Flags::program() const {
    return impl_->app.get_name();
}

void Flags::add_positionals(const std::string& name, std::vector<std::string>& field,
                            const std::string& description) {
    impl_->app.add_option(name, field, description)->required()->configurable(false);
}

int Flags::parse(int argc, const char* const* argv) {
    const CLI::App& app = impl_->app;
    const auto wrong = [&](const std::string& what) {
        std::fprintf(stderr, "%s: %s (see --help)\n", app.get_name().c_str(), what.c_str());
        return 2;
    };
    try {
        if (const std::string word = impl_->single_dash(argc, argv); !word.empty()) return wrong(word);
        impl_->app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        impl_->choose_for_help();
        std::ostringstream text;
        impl_->app.exit(success, text, text);
        return impl_->say(text.str());
    } catch (const CLI::ConfigError& error) {
        return wrong(app.get_config_ptr()->as<std::string>() + ":" + error.what());
    } catch (const CLI::Error& error) {
        const bool about_all = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                               dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
        const std::string complaint = about_all ? impl_->complaint() : "";
        if (!complaint.empty()) return wrong(complaint);
        if (!(impl_->dump && about_all)) return wrong(error.what());
    }
    if (!impl_->dump) return -1;
    return impl_->say(impl_->config());
}

std::vector<FlagValue> Flags::values() const {
    std::vector<FlagValue> values;
    for (const auto& [option, value, heading, expert] : impl_->known)
        values.push_back({impl_->name_of(option), value()});
    return values;
}

std::vector<OwnFlag> Flags::own() const {
    std::vector<OwnFlag> own;
    for (const auto& [option, value, heading, expert] : impl_->known) {
        if (heading.empty())
            own.push_back({impl_->name_of(option), config_text({"", value()}), option->get_description()});
    }
    return own;
}

}  // namespace planemap::messages
