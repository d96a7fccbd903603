flightwatt segment "$SOURCE/logs/opterra_synthetic_01.data" -o phases.csv || exit
head -n 1 phases.csv
awk -F, 'NR > 1 { printf "%d %s %.3f %.3f %.3f %d %.3f %.4f %.4f\n", $1, $2, $3, $4, $5, $6, $7, $8, $9 }' phases.csv
