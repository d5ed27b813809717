// From the core's poses to those the animation node shows.
#pragma once

#include "MetagraphComponent.h"
#include "MetagraphCore.h"
#include "MetagraphSpace.h"

namespace MetagraphPoses
{
	/** The names of a graph's joints, which are the bones' of a mesh imported from the same export. */
	inline TArray<FName> Bones(const metagraph::Graph& Graph)
	{
		TArray<FName> Out;
		for (const std::string& Joint : Graph.joints)
		{
			Out.Add(FName(*MetagraphText::Unreal(Joint)));
		}
		return Out;
	}

	/** The names of a graph's morph targets, which are those of animation curves. */
	inline TArray<FName> Curves(const metagraph::Graph& Graph)
	{
		TArray<FName> Out;
		for (const std::string& Morph : Graph.morphs)
		{
			Out.Add(FName(*MetagraphText::Unreal(Morph)));
		}
		return Out;
	}

	inline TSharedRef<FMetagraphPose, ESPMode::ThreadSafe> Made(
		const TArray<FName>& Bones, const metagraph::List<metagraph::Joined>& Pose, const TArray<FName>& Curves = {},
		const metagraph::List<double>& Weights = {})
	{
		const TSharedRef<FMetagraphPose, ESPMode::ThreadSafe> Out = MakeShared<FMetagraphPose, ESPMode::ThreadSafe>();
		Out->Bones = Bones;
		for (const metagraph::Joined& Joint : Pose)
		{
			const metagraph::Quat& Turn = Joint.rotation;
			const metagraph::Vec& Place = Joint.translation;
			Out->Transforms.Add(FTransform(
				MetagraphSpace::ToUnreal(Turn.x, Turn.y, Turn.z, Turn.w), MetagraphSpace::ToUnreal(Place.x, Place.y, Place.z)));
		}
		Out->Curves = Curves;
		for (const double Weight : Weights)
		{
			Out->Weights.Add(static_cast<float>(Weight));
		}
		return Out;
	}
}
