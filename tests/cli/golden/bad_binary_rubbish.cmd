awk 'BEGIN { for (i = 0; i < 9999; ++i) printf "%c", (i * i * 7 + i) % 256 }' > flight.data
flightwatt parse flight.data -o result.csv; code=$?; ls; exit $code
