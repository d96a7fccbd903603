flightwatt simulate --outptu x something
