#include "base/text_table.h"

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

const TextTable table{{"flight", "power_w"}, {{"a, b", "1.5"}, {"Ünal", "-"}}};

TEST(TextTable, AlignsNumbersToTheRightAndCountsCodePoints) {
    EXPECT_EQ(to_text(table), "flight  power_w\na, b        1.5\nÜnal          -\n");
}

TEST(TextTable, HasCellsOfSeveralLines) {
    EXPECT_EQ(aligned_text({{"mean\npower\nW", "\n\nname"}, {"12", "two\nwords"}}, {true, false}),
              " mean\npower\n    W  name\n   12  two\n       words\n");
}

TEST(TextTable, IsMarkdownAndCsvToo) {
    EXPECT_EQ(to_markdown(table), "| flight | power_w |\n|---|---:|\n| a, b | 1.5 |\n| Ünal | - |\n");
    EXPECT_EQ(to_csv(table), "flight,power_w\n\"a, b\",1.5\nÜnal,-\n");
}

TEST(TextTable, KeepsOddNamesFromBreakingTheTable) {
    const TextTable odd{{"name"}, {{"two\nlines | one"}}};
    EXPECT_EQ(to_text(odd), "name\ntwo lines | one\n");
    EXPECT_EQ(to_markdown(odd), "| name |\n|---|\n| two lines \\| one |\n");
}

TEST(TextTable, IsLatexWithTheRulesOfBooktabs) {
    EXPECT_EQ(to_latex(table, "Flights & power", "tab:flights"),
              R"(% needs \usepackage{booktabs}
\begin{table}
\centering
\caption{Flights \& power}
\label{tab:flights}
\begin{tabular}{lr}
\toprule
flight & power\_w \\
\midrule
a, b & $1.5$ \\
Ünal & -- \\
\bottomrule
\end{tabular}
\end{table}
)");
    const TextTable odd{{"", "95 %"}, {{"$\\input{x}$", "-0.012 to 3e-05"}}};
    EXPECT_NE(to_latex(odd, "", "").find("{lr}\n\\toprule\n & 95 \\% \\\\\n"), std::string::npos);
    EXPECT_NE(to_latex(odd, "", "").find("\\$\\textbackslash{}input\\{x\\}\\$ & $[-0.012,\\, 3 \\times 10^{-5}]$"),
              std::string::npos);
}

TEST(Latex, LeavesNoCharacterThatTexReadsOtherwise) {
    EXPECT_EQ(latex_escaped("a_b & 50 % {x} #1 $ ~ ^ \\"),
              "a\\_b \\& 50 \\% \\{x\\} \\#1 \\$ \\textasciitilde{} \\textasciicircum{} \\textbackslash{}");
    EXPECT_EQ(latex_escaped("\u00B1 2 W s^3/m^3"), "$\\pm$ 2 W s$^3$/m$^3$");
    EXPECT_EQ(latex_escaped("[km] * <a> |\""), "{[}km] {*} \\textless{}a\\textgreater{} \\textbar{}{\\char34}");
    EXPECT_EQ(latex_escaped("take\u2011off \xC3\xA9 \u6c34 \xFF\n\x01"), "take-off \xC3\xA9 ? ? ?");
    EXPECT_EQ(latex_escaped("cut \xE6\xB0"), "cut ?") << "a character that ends too early";
}

TEST(Latex, SpellsExponents) {
    EXPECT_EQ(latex_number("-1.5e-05"), "-1.5 \\times 10^{-5}");
    EXPECT_EQ(latex_number("2e+06"), "2 \\times 10^{6}");
    EXPECT_EQ(latex_number("0.25"), "0.25");
}

TEST(Fixed, IsADashForWhatIsNotKnown) {
    EXPECT_EQ(fixed(1.25, 3), "1.250");
    EXPECT_EQ(fixed(std::nullopt, 3), "-");
}

}  // namespace
}  // namespace flightwatt
