"""What may be limited, weighed and listed: quantities, requirements, objectives."""
