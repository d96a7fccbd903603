#include "path/plans/plan_expressions.h"

#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <boost/algorithm/string/replace.hpp>

namespace flightwatt::path {
namespace {

/// Without blanks: expression = term {(+|-) term}, term = factor {(*|/) factor},
/// factor = [-] (number | name[(...)] | (expression)). What is not known is NaN.
class Expression {
  public:
    Expression(std::string_view text, const NamedValues& value_of) : rest_(text), value_of_(value_of) {}

    std::optional<double> value() {
        const double result = sum();
        return rest_.empty() && std::isfinite(result) ? std::optional(result) : std::nullopt;
    }

  private:
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    bool take(char symbol) {
        if (!rest_.starts_with(symbol)) return false;
        rest_.remove_prefix(1);
        return true;
    }

    double sum() {
        for (double value = product();;) {
            if (take('+'))
                value += product();
            else if (take('-'))
                value -= product();
            else
                return value;
        }
    }

    double product() {
        for (double value = factor();;) {
            if (take('*'))
                value *= factor();
            else if (take('/'))
                value /= factor();
            else
                return value;
        }
    }

    double factor() {
        constexpr int max_factors = 1000;
        if (++factors_ > max_factors) return unknown;
        if (take('-')) return -factor();
        if (take('(')) {
            const double value = sum();
            return take(')') ? value : unknown;
        }
        const auto is_in_name = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '[' || c == ']';
        };
        auto length = static_cast<std::size_t>(std::ranges::find_if_not(rest_, is_in_name) - rest_.begin());
        if (rest_.substr(length).starts_with('(')) length = std::min(rest_.find(')', length), rest_.size() - 1) + 1;
        const std::string name(rest_.substr(0, length));
        rest_.remove_prefix(length);
        const auto number = parse_number(name.ends_with('f') ? name.substr(0, name.size() - 1) : name);
        return number ? *number : value_of_(name).value_or(unknown);
    }

    std::string_view rest_;
    const NamedValues& value_of_;
    int factors_ = 0;  ///< limits the depth of the recursion
};

std::string without_blanks(std::string text) {
    std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
    return text;
}

}  // namespace

std::optional<double> evaluate(std::string_view expression, const NamedValues& value_of) {
    const auto text = without_blanks(std::string(expression));
    return Expression(text, value_of).value();
}

std::pair<std::string, std::vector<std::string>> function_call(const std::string& text) {
    const auto call = without_blanks(text);
    const auto open = std::min(call.find('('), call.size());
    const auto close = std::min(call.rfind(')'), call.size());
    return {call.substr(0, open),
            close > open ? split(call.substr(open + 1, close - open - 1), ",") : std::vector<std::string>()};
}

std::optional<double> find_limit(const std::string& condition, std::initializer_list<std::string_view> names) {
    auto text = boost::algorithm::replace_all_copy(without_blanks(condition), "@GT", ">");
    boost::algorithm::replace_all(text, "@GEQ", ">=");
    std::erase_if(text, [](char c) { return c == '(' || c == ')'; });
    const auto above = text.find('>');
    if (above == std::string::npos || std::ranges::find(names, text.substr(0, above)) == names.end())
        return std::nullopt;
    return parse_number(std::string_view(text).substr(above + (text.substr(above).starts_with(">=") ? 2 : 1)));
}

}  // namespace flightwatt::path
