flightwatt synthesize "$SOURCE/fits/mechanical/opterra-table1.toml" --flights 1 --name one --truth -o made || exit
ls made; head -n 3 made/one_01.data | cut -d ' ' -f 1-3; awk -F, 'NR > 1 { printf "%s %.1f %.1f\n", $1, $2, $3 }' made/one_01.truth.csv
