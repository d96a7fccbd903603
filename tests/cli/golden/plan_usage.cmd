for p in 0.4 1 nan often; do flightwatt plan "$SOURCE/missions/paper/plan.toml" --probability=$p; echo $?; done
flightwatt plan "$SOURCE/missions/paper/plan.toml" --longest-cruise --largest-payload; echo $?
flightwatt plan "$SOURCE/missions/paper/plan.toml" --longest-cruise --probability 0.9; echo $?
