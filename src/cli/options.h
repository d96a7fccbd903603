#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>

/// The options of a stage. Each is declared once and bound to the variable that it sets; checks, --help, --json-usage,
/// man page and completion are made from this declaration.
namespace flightwatt::cli {

/// Use of the file (or folder) that an option names. Files to write are checked before any work: none may be read as
/// well, and no two may be one.
enum class FileRole { none, input, output };

/// Declaration of an option beyond its name, its variable and its description.
struct OptionDetails {
    std::string value = {};  ///< name of its value in --help: "AH"
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool above_min = false;  ///< min itself is refused
    bool below_max = false;  ///< max itself is refused
    std::string unit = {};   ///< of the number; of a time (s) min and h are read as well
    double scale = 1.0;      ///< a whole number is multiplied by this
    std::string hint = {};   ///< how to correct a number outside the range
    FileRole file = FileRole::none;
    std::vector<std::string> needs = {};     ///< options of which one has to be given with it
    std::vector<std::string> excludes = {};  ///< options that must not be given with it
    std::string old_name = {};               ///< accepted for one version, not documented
};

inline OptionDetails input_file(std::string value) { return {.value = std::move(value), .file = FileRole::input}; }
inline OptionDetails output_file(std::string value) { return {.value = std::move(value), .file = FileRole::output}; }

/// A declared option.
struct Option : OptionDetails {
    std::string name;
    std::string short_name;  ///< "o", or empty
    std::string type;        ///< "flag", "number", "integer", "date", "text" or "choice"
    std::vector<std::string> choices;
    std::string default_text;  ///< empty: none
    std::string description;
    std::string group;
    bool is_expert = false;  ///< shown by --help-all alone
    bool is_repeatable = false;
    std::function<void(const std::vector<std::string>& texts)> assign;
};

/// The values of a text. Throw UsageError "--NAME TEXT: expected ..." for another one.
double parse_number_option(const Option& option, const std::string& text);
std::uint64_t parse_integer_option(const Option& option, const std::string& text);
std::size_t parse_choice_option(const Option& option, const std::string& text);
std::chrono::sys_days parse_date_option(const Option& option, const std::string& text);

template <typename T>
T parse_option(const Option& option, const std::string& text) {
    if constexpr (std::is_floating_point_v<T>)
        return parse_number_option(option, text);
    else if constexpr (std::is_integral_v<T>)
        return static_cast<T>(parse_integer_option(option, text));
    else if constexpr (std::is_same_v<T, std::chrono::sys_days>)
        return parse_date_option(option, text);
    else
        return T(text);
}

template <typename T>
constexpr const char* option_type() {
    if constexpr (std::is_floating_point_v<T>)
        return "number";
    else if constexpr (std::is_integral_v<T>)
        return "integer";
    else
        return std::is_same_v<T, std::chrono::sys_days> ? "date" : "text";
}

/// The type of one value of a variable: T of T, std::optional<T>, std::vector<T> and std::set<T>.
template <typename T>
struct OptionValue {
    using Type = T;
};
template <typename T>
struct OptionValue<std::optional<T>> : OptionValue<T> {};
template <typename T>
struct OptionValue<std::vector<T>> : OptionValue<T> {};
template <typename T>
struct OptionValue<std::set<T>> : OptionValue<T> {};

std::string default_text(const Option& option, double value);
inline std::string default_text(const Option&, const std::string& value) { return value; }

class Options {
  public:
    /// The heading of the options that are added next, and options of which one has to be given with each of them.
    void begin_group(std::string title, bool is_expert = false, std::vector<std::string> needs = {});

    /// A flag, "name" or "name,n".
    void add(const std::string& name, bool& variable, const std::string& description, OptionDetails details = {});

    /// A number, text or path, or several in a container. The value of a plain variable is the default.
    template <typename T>
    void add(const std::string& name, T& variable, OptionDetails details, const std::string& description) {
        using Value = typename OptionValue<T>::Type;
        constexpr bool is_plain = std::is_same_v<T, Value>;
        constexpr bool is_optional = std::is_same_v<T, std::optional<Value>>;
        auto option = declare(name, std::move(details), description);
        option.type = option_type<Value>();
        option.is_repeatable = !is_plain && !is_optional;
        if constexpr (is_plain) option.default_text = default_text(option, variable);
        append(std::move(option), [&variable](const Option& own, const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
                if constexpr (is_plain || is_optional)
                    variable = parse_option<Value>(own, text);
                else
                    variable.insert(variable.end(), parse_option<Value>(own, text));
            }
        });
    }

    /// One of several words, the first of which is the default.
    template <typename T>
    void add_choice(const std::string& name, T& variable, const std::vector<std::pair<std::string, T>>& choices,
                    OptionDetails details, const std::string& description) {
        auto option = declare(name, std::move(details), description);
        option.type = "choice";
        for (const auto& [word, value] : choices) {
            option.choices.push_back(word);
            if (value == variable) option.default_text = word;
        }
        append(std::move(option), [&variable, choices](const Option& own, const std::vector<std::string>& texts) {
            variable = choices[parse_choice_option(own, texts.front())].second;
        });
    }

    /// A rule for several values together, run when all are set. Throws UsageError.
    void add_rule(std::function<void()> rule) { rules_.push_back(std::move(rule)); }

    const std::vector<Option>& all() const { return options_; }
    const Option* find(const std::string& name) const;

    /// --help's lists in lines of so many characters, of expert options too with `all`.
    std::string help_text(bool all, std::size_t columns = 80) const;

    /// A line an option with name, short name, kind, value and description, between tabs: for completion and man pages.
    std::string list_text() const;

    nlohmann::ordered_json json() const;

    /// The given options: the texts of each option by its name, and the positional arguments.
    struct Given {
        std::vector<std::pair<std::string, std::vector<std::string>>> options;
        std::vector<std::string> inputs;
    };

    /// Throws UsageError for what is not known, or given twice.
    Given parse(int argc, char** argv) const;

    /// Sets the variables, and checks what belongs together. Throws UsageError.
    void assign(const Given& given) const;

  private:
    using Assign = std::function<void(const Option& own, const std::vector<std::string>& texts)>;

    Option declare(const std::string& name, OptionDetails details, const std::string& description) const;
    void append(Option option, Assign assign);

    std::vector<Option> options_;
    std::vector<std::function<void()>> rules_;
    std::string group_ = "Options";
    bool is_expert_ = false;
    std::vector<std::string> needs_;
};

}  // namespace flightwatt::cli
