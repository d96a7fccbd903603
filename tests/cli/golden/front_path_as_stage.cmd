flightwatt ../parse x.data
