for step in 0 -1 nan inf 1e-9 fast; do flightwatt simulate "$SOURCE/missions/paper/phased.toml" --step=$step; echo $?; done
