awk 'BEGIN { for (i = 0; i < 300; ++i) printf "%d.000 7 ENERGY 0 12.5 0.03 0.36 0.001 0.01\n%d.500 7 ESTIMATOR 15.0 0.\n", i, i }' > flight.data
flightwatt fit flight.data -o result.csv; code=$?; ls; exit $code
