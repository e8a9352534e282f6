"""The handbook's chapter on world modeling, its indoor half: plan-view maps, each figure again."""
