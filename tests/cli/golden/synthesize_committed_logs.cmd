# As scripts/make_sample_logs does it: the committed logs come out again, byte for byte.
flightwatt synthesize "$SOURCE/fits/mechanical/opterra-table1.toml" --flights 6 --seed 1 -o made 2> /dev/null || exit
grep -o 'flightwatt synthesize .*' "$SOURCE/scripts/make_sample_logs"
flightwatt synthesize "$SOURCE/fits/mechanical/opterra-table1.toml" --flights 1 --seed 2 --hazard all --cruise 300 --flight-messages-only --truth --name hazard -o made/hazards 2> /dev/null || exit
for file in made/*.* made/hazards/*; do cmp "$file" "$SOURCE/logs/${file#made/}" && echo "same $file"; done
