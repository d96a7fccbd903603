flightwatt simulate "$SOURCE/missions/paper/phased.toml" --step 100 > soc.csv || exit
head -n 1 soc.csv
awk -F, 'NR > 1 { printf "%.2f %s %.2f %.2f %.2f %.2f %.2f\n", $1, $2, $3, $4, $5, $6, $7 }' soc.csv
