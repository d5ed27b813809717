#pragma once

#include "CoreMinimal.h"
#include "Components/ActorComponent.h"
#include "MetagraphComponent.generated.h"

class UMetagraphAsset;
class USkeletalMeshComponent;
struct FMetagraphCharacter;
struct FMetagraphValue;

/** A pose as the animation node reads it, on any thread: bones by name, local, in Unreal's space. Never changed once made. */
struct METAGRAPH_API FMetagraphPose
{
	TArray<FName> Bones;
	TArray<FTransform> Transforms;
	/** Morph targets, and how much each shows, 0 to 1. */
	TArray<FName> Curves;
	TArray<float> Weights;
};

/** What becomes of a request. */
USTRUCT(BlueprintType)
struct METAGRAPH_API FMetagraphAnswer
{
	GENERATED_BODY()

	/** planned, late, refused or done. */
	UPROPERTY(BlueprintReadOnly, Category = "Metagraph")
	FString State;

	/** When it plays, seconds of the character's time; -1 where that is not known, or never. */
	UPROPERTY(BlueprintReadOnly, Category = "Metagraph")
	float At = -1.0f;

	UPROPERTY(BlueprintReadOnly, Category = "Metagraph")
	float Until = -1.0f;

	/** Names of the actions that play. */
	UPROPERTY(BlueprintReadOnly, Category = "Metagraph")
	TArray<FString> What;

	/** Why not as asked. */
	UPROPERTY(BlueprintReadOnly, Category = "Metagraph")
	FString Why;
};

/** Layer ("speech" for what is said); Action: its name, of what is said the line's id or its words; Request: the id it is for. */
DECLARE_DYNAMIC_MULTICAST_DELEGATE_ThreeParams(FMetagraphHappened, FString, Layer, FString, Action, FString, Request);

/**
 * A character: plans what it is asked, and makes a pose each frame, which the animation node "Metagraph" of the same actor's
 * animation blueprint shows. It plans on the game thread; the node takes poses from any thread.
 */
UCLASS(ClassGroup = (Animation), meta = (BlueprintSpawnableComponent))
class METAGRAPH_API UMetagraphComponent : public UActorComponent
{
	GENERATED_BODY()

public:
	UMetagraphComponent();

	/** The export it plays. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	TObjectPtr<UMetagraphAsset> Asset;

	/** What chance draws from; 0 for the export's own. Characters of one export want different ones. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	int32 Seed = 0;

	/** Whether it moves of its own accord when nobody asks for anything. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	bool bIdle = true;

	/** Whether it breathes, looks, blinks and moves its lips. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	bool bAlive = true;

	/** Whether a mesh without an Anim Class gets UMetagraphAnimInstance, so that no animation blueprint is needed. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	bool bDriveMesh = true;

	/** Whether morph targets of the mesh are set, too, beside the animation curves of their names. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	bool bMorphTargets = true;

	/** Whether gestures go with the words it says. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	bool bGestures = true;

	/** Of the words that gestures go with: en, de, es, fr. */
	UPROPERTY(EditAnywhere, BlueprintReadWrite, Category = "Metagraph")
	FString Language = TEXT("en");

	UPROPERTY(BlueprintAssignable, Category = "Metagraph")
	FMetagraphHappened OnBegin;

	UPROPERTY(BlueprintAssignable, Category = "Metagraph")
	FMetagraphHappened OnEnd;

	/** Ask for something, as JSON: {"do": "gesture", "tags": ["positive"]}. Returns the request's id. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Ask(const FString& Request);

	/** Ask for several things at once. Returns their ids. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	TArray<FString> Hear(const TArray<FString>& Requests);

	/** Say words, with gestures that go with them unless bGestures is off. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Say(const FString& Text);

	/** Say what comes in piece by piece, as a language model writes it: each sentence, with its gestures, when it is whole, after the
	 *  one before. bOver: whether the text ends here. Returns the ids of what it says by it. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	TArray<FString> SayPiece(const FString& Piece, bool bOver);

	/** Say a line of the export, with what it asks for meanwhile. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SayLine(const FString& Line);

	/** Say a line whose sound comes in while it is said: with each call its next samples, -1..1; the lips do what is heard. An id
	 *  is one line's. Rate: samples a second, 8000 to 48000. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SaySound(const FString& Id, const TArray<float>& Samples, float Rate);

	/** Look at a place in the world, until the next look. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString LookAt(FVector Place);

	/** Look at a named point of the export; "user" is whom it talks with, "ahead" nothing in particular. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString LookAtPoint(const FString& Point);

	/** Make a gesture that has all the tags. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Gesture(const TArray<FString>& Tags);

	/** Go to a stance, by id or name. bStay: the models do not leave it of their own accord. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Stance(const FString& Stance, bool bStay);

	/** Put a named point of the export at a place in the world; who looks at it follows it. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString PlacePoint(const FString& Point, FVector Place);

	/** Be in a mood from now on: "happy", "sad" and others; "neutral" ends it. Intensity: 0 to 1. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Mood(const FString& Mood, float Intensity = 1.0f);

	/** From now on be "idle", "listening", "talking", "thinking" or "reacting"; empty leaves it to what is said. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Mode(const FString& Mode);

	/** Set a parameter that the project declares to a number, which is kept within its range. Returns the id of the request. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SetParameterNumber(const FString& Parameter, float Value);

	/** Set a parameter that is a switch. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SetParameterSwitch(const FString& Parameter, bool bOn);

	/** Set a parameter to one of its choices. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SetParameterChoice(const FString& Parameter, const FString& Choice);

	/** Set a parameter to some of its choices. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SetParameterChoices(const FString& Parameter, const TArray<FString>& Choices);

	/** Set a parameter to a place in the world. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString SetParameterPoint(const FString& Parameter, FVector Place);

	/** Play a parameter that is a trigger. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString PlayParameter(const FString& Parameter);

	/** Break off all that is said, because the other speaks: the voice stops at its next sound, gestures go back, and the character
	 *  looks at the other. What is said next begins at once. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Interrupt();

	/** The value of a parameter, as JSON: what it was set to, else its first one. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Parameter(const FString& Name) const;

	/** Take a request back; all of them where no id is given. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Withdraw(const FString& Request);

	/** What becomes of a request. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FMetagraphAnswer Answer(const FString& Request) const;

	/** What may be asked, as JSON. */
	UFUNCTION(BlueprintCallable, Category = "Metagraph")
	FString Describe() const;

	/** Seconds of the character's own time. */
	UFUNCTION(BlueprintPure, Category = "Metagraph")
	float Now() const;

	/** The latest pose, for the animation node; nothing before the first frame. */
	TSharedPtr<const FMetagraphPose, ESPMode::ThreadSafe> Pose() const { return Latest; }

	/** Move on by seconds; what a frame does. */
	void Advance(float Seconds);

	virtual void BeginPlay() override;
	virtual void TickComponent(float DeltaTime, ELevelTick TickType, FActorComponentTickFunction* ThisTickFunction) override;

private:
	TSharedPtr<FMetagraphCharacter> Character;
	TSharedPtr<const FMetagraphPose, ESPMode::ThreadSafe> Latest;
	TArray<FName> Bones;
	TArray<FName> Curves;

	UPROPERTY(Transient)
	TObjectPtr<USkeletalMeshComponent> Mesh;

	bool Begin();
	FString SetParameter(const FString& Parameter, const FMetagraphValue& Value);
	FVector OwnSpace(FVector Place) const;
	void Tell();
	void Show();
};
