flightwatt parse "$SOURCE/logs/opterra_synthetic_01.data" > series.csv || exit
head -n 3 series.csv; wc -l < series.csv
