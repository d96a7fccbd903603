echo 'Dear diary, today I flew.' > flight.data
flightwatt fit flight.data -o result.csv; code=$?; ls; exit $code
