cp "$SOURCE/logs/opterra_synthetic_01.data" flight.data; echo '<configuration><protocol></protocol></configuration>' > flight.log
flightwatt parse flight.data -o result.csv; code=$?; ls; exit $code
