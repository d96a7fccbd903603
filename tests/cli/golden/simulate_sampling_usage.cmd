cd "$SOURCE"
flightwatt simulate missions/paper/phased.toml --seed 3; echo $?
flightwatt simulate missions/paper/phased.toml --samples many; echo $?
flightwatt simulate missions/paper/phased.toml --samples-csv bands.csv; echo $?
