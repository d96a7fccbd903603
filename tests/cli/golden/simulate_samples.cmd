cp -r "$SOURCE/fits" "$SOURCE/missions" .
printf "duration_sd_s = { cruise = 10 }\n" >> missions/paper/phased.toml
flightwatt simulate missions/paper/phased.toml --samples 1000 --seed 1 -o curve.csv --samples-csv bands.csv || exit
sed -n '1,2p; $p' bands.csv
flightwatt simulate missions/paper/phased.toml --samples 1000 --seed 1 --json | sed -n '/reserve_soc/,$p'
