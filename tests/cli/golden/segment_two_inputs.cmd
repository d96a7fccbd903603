flightwatt segment one two
