flightwatt parse "$SOURCE/logs/opterra_synthetic_01.data" -o series.csv || exit
head -n 2 series.csv; ls
