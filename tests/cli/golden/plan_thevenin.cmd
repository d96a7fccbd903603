# A battery whose voltage falls with its charge: the bound is that of the highest voltage that any schedule keeps.
flightwatt plan "$SOURCE/missions/synthetic/thevenin-plan.toml" -o plan.toml || exit
flightwatt simulate plan.toml -o soc.csv
