flightwatt plan "$SOURCE/missions/paper/phased.toml"; echo $?
flightwatt simulate "$SOURCE/missions/paper/plan.toml"
