cp -r "$SOURCE/fits" "$SOURCE/missions" .
flightwatt simulate missions/paper/adaptive-replanned.toml --disturb missions/disturbances/headwind.toml --schedule-out flown.toml --json || exit
tail -n 5 flown.toml
flightwatt simulate flown.toml --disturb missions/disturbances/headwind.toml -o curve.csv
