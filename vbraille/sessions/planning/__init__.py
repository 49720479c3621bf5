"""What is shown to whom, in which order: protocols and plans, before anyone sits down."""
