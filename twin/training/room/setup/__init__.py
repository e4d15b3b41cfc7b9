"""What is set up at the machine: the stock on the table, and the tool that touches and cuts it."""
